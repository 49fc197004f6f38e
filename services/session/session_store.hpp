#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "services/session/session_snapshot.hpp"

namespace limbcast::session {

/// Keeps a SessionSnapshot in sessions.toml of a folder. A save writes beside it, waits for the
/// disk and renames, and leaves the one before as sessions.toml.old: a crash at any moment leaves a
/// whole one. A file that was refused is set aside as sessions.toml.refused before it is replaced.
/// Thread-compatible.
class SessionStore {
 public:
  /// `folder` empty: nothing is kept.
  explicit SessionStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Makes the folder. Fails with kUnavailable when it cannot be written to.
  [[nodiscard]] Status Prepare() const;

  [[nodiscard]] Status Save(const SessionSnapshot& snapshot);

  struct Loaded {
    SessionSnapshot snapshot;
    std::string warning;  ///< why it is not what was saved last; empty = it is
  };
  /// What was saved last; the one before when that file is not whole; nothing at the first start.
  /// Fails with kCorruptData when there are files and none of them is whole.
  [[nodiscard]] Result<Loaded> Load();

  /// The file that Load gave is no good for another reason: it is set aside like a broken one.
  void Refuse() { refused_ = true; }

  [[nodiscard]] std::filesystem::path path() const { return folder_ / "sessions.toml"; }

 private:
  std::filesystem::path folder_;
  bool refused_ = false;
};

/// The file's text, and back (kCorruptData, naming file, line and key). `name` stands for the file.
[[nodiscard]] std::string ToToml(const SessionSnapshot& snapshot);
[[nodiscard]] Result<SessionSnapshot> FromToml(const std::string& text, const std::string& name);

}  // namespace limbcast::session
