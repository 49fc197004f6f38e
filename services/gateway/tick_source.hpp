#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/base/result.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/gateway_config.hpp"
#include "services/gateway/stream_clock.hpp"

namespace limbcast::gateway {

/// Puts gateway.person in place of the driver's names, unless it is empty.
void Name(const std::string& person, std::vector<roster::RosterEntry>& bodies);

/// A driver as the service uses it: loops joined, body ids and times as they go onto the network,
/// and when each tick is due. One tick is loaded at a time. Thread-compatible except Interrupt.
class TickSource {
 public:
  TickSource(std::unique_ptr<Driver> driver, const GatewayConfig& config);

  /// The driver's, with our body ids and session.
  [[nodiscard]] const DriverDescription& description() const { return description_; }
  [[nodiscard]] bool live() const { return description_.time == DriverTime::kHost; }

  /// From the next tick on the driver's sources of coils pulse as `schedule` says, whose body ids
  /// are those of the network. The driver is told when it is another one than before, or when our
  /// time jumped.
  ///
  /// @param start_at  as for Load.
  /// @returns what the driver answers; Ok when it was not told.
  [[nodiscard]] Status FollowSlots(std::shared_ptr<const CoilSchedule> schedule, Time start_at);

  /// Loads the next tick (kData). The first tick of a recording is due at `start_at`, and its time
  /// becomes that. Nothing may be loaded before.
  [[nodiscard]] Result<DriverStep> Load(Time start_at);
  [[nodiscard]] bool loaded() const { return loaded_; }

  /// When the loaded tick is to be sent. Live: at once.
  [[nodiscard]] Time DueAt(Time now) const;
  /// The same at speed 1, whatever the pace.
  [[nodiscard]] Time DueInRealTime(Time now) const;

  /// Hands out the loaded tick to be sent `now`, its times on the host's scale.
  [[nodiscard]] Batch& Take(Time now);

  /// Of the tick handed out last: how late it is, and whether its time had to jump to now.
  [[nodiscard]] Duration lag() const { return stream_clock_.lag(); }
  [[nodiscard]] bool jumped() const { return jumped_; }

  [[nodiscard]] std::uint64_t loops() const { return loops_; }
  /// Data handed out so far, in the source's own time.
  [[nodiscard]] Duration streamed() const { return streamed_; }

  void Interrupt() { driver_->Interrupt(); }

 private:
  [[nodiscard]] Result<DriverStep> Next();
  [[nodiscard]] BodyId Renumbered(BodyId body) const;
  void MapToHost(Time now);

  const std::unique_ptr<Driver> driver_;
  DriverDescription description_;
  const bool loop_;
  const Duration period_;
  std::int64_t body_id_offset_ = 0;
  std::unordered_map<BodyId, BodyId> granted_;  // the driver's to the session host's
  StreamClock stream_clock_;
  std::shared_ptr<const CoilSchedule> schedule_;
  Duration scheduled_to_host_{};
  Batch batch_;
  bool loaded_ = false;
  bool jumped_ = false;
  std::uint64_t loops_ = 0;
  std::optional<Time> first_tick_at_;  // recording time
  std::optional<Time> last_tick_at_;   // of the tick taken last; nothing at the start of a loop
  Duration streamed_{};
};

}  // namespace limbcast::gateway
