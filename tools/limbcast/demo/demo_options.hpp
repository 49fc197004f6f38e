#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/bus_config.hpp"

namespace limbcast::tool {

/// Which DDS library each process of a demo runs on.
enum class DemoDds : std::uint8_t {
  kCyclone,
  kFast,
  kMixed,  ///< gateway and posture on Cyclone, fusion and client on Fast: every hop crosses
};

struct DemoOptions {
  DemoDds dds = DemoDds::kCyclone;
  bus::BusConfig bus;    ///< of the client; the others get domain, partition and network of it
  double seconds = 0.0;  ///< 0 = until Ctrl-C or the end of the recording
  /// Latency and CPU time count from then on; losses from the begin. Less than `seconds`.
  double settle_seconds = 0.0;
  bool quiet = false;           ///< nothing on stdout
  std::string recording;        ///< "" = the simulator
  std::string speed;            ///< of the recording: a factor or "max"; "" = max
  std::string json_path;        ///< "" = no JSON
  std::string folder;           ///< where the executables are
  bool segment_states = false;  ///< the client listens to segment_state too
  bool coils = false;           ///< people wear coils; wrists and shins are tracked from the pelvis
  bool markers = false;         ///< cameras see a marker on each pelvis
  std::vector<std::string> service_settings;  ///< KEY=VALUE, handed to all three as --set
  std::vector<std::string> gateway_settings;  ///< KEY=VALUE, handed to the gateway as --set
  std::vector<std::string> fusion_settings;   ///< KEY=VALUE, handed to fusion as --set
};

[[nodiscard]] std::string_view ToString(DemoDds dds);

/// "cyclone" or "fast" for "gateway", "fusion", "posture" or "client".
[[nodiscard]] std::string_view VendorOf(DemoDds dds, std::string_view process);

}  // namespace limbcast::tool
