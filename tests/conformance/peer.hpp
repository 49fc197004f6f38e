#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "tests/conformance/peer_session.hpp"

namespace limbcast::conformance {

/// A PeerSession near or far.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Sends one command and waits for its reply; "error ..." also when the peer is gone or silent.
  [[nodiscard]] virtual std::string Do(const std::string& line) = 0;
};

/// Within this process.
class LocalPeer final : public Peer {
 public:
  [[nodiscard]] std::string Do(const std::string& line) override { return session_.Do(line); }

 private:
  PeerSession session_;
};

/// A process that answers lines, e.g. bus_peer: the executable `path`. Destroying it ends the
/// process in good order.
class ProcessPeer final : public Peer {
 public:
  explicit ProcessPeer(std::string path);
  ~ProcessPeer() override;
  ProcessPeer(const ProcessPeer&) = delete;
  ProcessPeer& operator=(const ProcessPeer&) = delete;

  [[nodiscard]] std::string Do(const std::string& line) override;
  /// kill -9; returns when the process is gone.
  void Kill();

 private:
  void Reap();

  pid_t pid_ = -1;
  int to_peer_ = -1;
  int from_peer_ = -1;
  std::string received_;
};

}  // namespace limbcast::conformance
