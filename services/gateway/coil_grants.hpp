#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "services/gateway/driver.hpp"

namespace limbcast::gateway {

/// When the gateway's sources of coils may pulse and when others do, from the roster of its session
/// (design/position.md section 11). A person whose entry is not there, or is taken away, has no
/// grant. Two of one slot without a host that keeps them apart: the one with the lower body id
/// keeps it. Thread-safe.
class CoilGrants {
 public:
  /// `bus` outlives this.
  ///
  /// @param own  the gateway's people.
  [[nodiscard]] static Result<std::unique_ptr<CoilGrants>> Make(bus::Bus& bus,
                                                                std::vector<BodyId> own);

  /// As it is now, with the network's body ids; another object whenever it changed.
  [[nodiscard]] std::shared_ptr<const CoilSchedule> schedule() const;

 private:
  explicit CoilGrants(std::vector<BodyId> own) : own_(std::move(own)) { Rebuild(); }
  void Take(const roster::RosterEntry& entry);
  void Forget(BodyId body);
  void Rebuild();
  [[nodiscard]] bool IsOwn(BodyId body) const;
  [[nodiscard]] bool Yields(BodyId body, const sensing::CoilGrant& grant) const;

  const std::vector<BodyId> own_;
  mutable std::mutex mutex_;  // guards the next two
  std::map<BodyId, sensing::CoilGrant> granted_;
  std::shared_ptr<const CoilSchedule> schedule_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> reader_;
};

}  // namespace limbcast::gateway
