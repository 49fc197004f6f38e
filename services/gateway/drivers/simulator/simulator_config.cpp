#include "services/gateway/drivers/simulator/simulator_config.hpp"

#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/range.hpp"
#include "common/config/named_values.hpp"
#include "common/units/units.hpp"

namespace limbcast::gateway {
namespace {

using simulation::MountingStyle;
using simulation::NoisePreset;
using simulation::SensorSet;

template <typename Enum, std::size_t kSize>
using Names = std::array<std::pair<std::string_view, Enum>, kSize>;

constexpr Names<SensorSet, 3> kSensorSets = {{{"reduced15", SensorSet::kReduced15},
                                              {"standard17", SensorSet::kStandard17},
                                              {"all23", SensorSet::kAll23}}};
constexpr Names<NoisePreset, 3> kNoises = {{{"ideal", NoisePreset::kIdeal},
                                            {"default", NoisePreset::kDefault},
                                            {"poor", NoisePreset::kPoor}}};
constexpr Names<MountingStyle, 3> kMountings = {{{"aligned", MountingStyle::kAligned},
                                                 {"rough", MountingStyle::kRough},
                                                 {"arbitrary", MountingStyle::kArbitrary}}};
constexpr Names<SimulatedMotion, 2> kMotions = {
    {{"default", SimulatedMotion::kDefault}, {"standing", SimulatedMotion::kStanding}}};

template <typename Enum>
using Choices = std::span<const std::pair<std::string_view, Enum>>;

struct Range {
  double min;
  double max;
};
constexpr Range kPersons = {1, 256};
constexpr Range kRate_hz = {1.0, 1000.0};
constexpr Range kDuration_s = {0.0, 1e7};
constexpr Range kNPose_s = {0.5, 3600.0};
constexpr Range kHeight_m = {1.2, 2.2};
constexpr Range kSpacing_m = {1.0, 1000.0};
constexpr std::size_t kMaxPrefix = 16;

void ReadFaults(const config::Section& section, FaultConfig& faults) {
  for (const auto& [name, fault] : FaultNames()) {
    double& rate = faults.rate[static_cast<std::size_t>(fault)];
    rate = section.Read(std::string(name) + "_rate", rate, 0.0, 1.0);
  }
  faults.gap_ticks = section.Read("gap_ticks", faults.gap_ticks, 1U, 100'000U);
  for (const config::Section& entry : section.GetAll("list")) {
    ListedFault listed;
    listed.tick = entry.Read("tick", listed.tick, 0U, 1'000'000'000'000U);
    listed.body = entry.Read("body", listed.body, 1U, 1'000'000U);
    listed.segment = config::ReadNamed(entry, "segment", listed.segment, body::ParseSegment,
                                       "a segment like right_fore_arm");
    listed.fault = entry.Read("fault", listed.fault, FaultNames());
    faults.list.push_back(listed);
  }
}

}  // namespace

SimulatorConfig ReadSimulatorConfig(const config::Section& section, SimulatorConfig defaults) {
  const auto real = [&section](std::string_view key, double value, const Range& range) {
    return section.Read(key, value, range.min, range.max);
  };
  SimulatorConfig config = std::move(defaults);
  config.persons = section.Read("persons", config.persons, 1U, 256U);
  config.rate_hz = real("rate_hz", config.rate_hz, kRate_hz);
  config.sensors = section.Read("sensors", config.sensors, Choices<SensorSet>(kSensorSets));
  config.duration_s = real("duration_s", config.duration_s, kDuration_s);
  config.seed = section.Read("seed", config.seed, 0U, std::uint64_t{1} << 62U);
  config.noise = section.Read("noise", config.noise, Choices<NoisePreset>(kNoises));
  config.mounting = section.Read("mounting", config.mounting, Choices<MountingStyle>(kMountings));
  config.motion = section.Read("motion", config.motion, Choices<SimulatedMotion>(kMotions));
  config.n_pose_s = real("n_pose_s", config.n_pose_s, kNPose_s);
  config.facing_rad = units::RadFromDeg(
      section.Read("facing_deg", units::DegFromRad(config.facing_rad), -360.0, 360.0));
  config.height_m = real("height_m", config.height_m, kHeight_m);
  config.spacing_m = real("spacing_m", config.spacing_m, kSpacing_m);
  config.iron = section.Read("iron", config.iron);
  config.magnetometer = section.Read("magnetometer", config.magnetometer);
  config.serial_prefix = section.Read("serial_prefix", config.serial_prefix, kMaxPrefix);
  ReadFaults(section.Get("faults"), config.faults);
  config.coils = ReadSimulatedCoils(section.Get("coils"), std::move(config.coils));
  config.cameras = ReadSimulatedCameras(section.Get("cameras"), std::move(config.cameras));
  return config;
}

Status Validate(const SimulatorConfig& config) {
  const auto ranged = [](std::string_view name, double value, const Range& range) {
    return RangedValue{.name = name, .value = value, .min = range.min, .max = range.max};
  };
  if (Status ok = CheckRanges("simulator.",
                              {ranged("persons", static_cast<double>(config.persons), kPersons),
                               ranged("rate_hz", config.rate_hz, kRate_hz),
                               ranged("duration_s", config.duration_s, kDuration_s),
                               ranged("n_pose_s", config.n_pose_s, kNPose_s),
                               ranged("facing_rad", config.facing_rad, {-6.3, 6.3}),
                               ranged("height_m", config.height_m, kHeight_m),
                               ranged("spacing_m", config.spacing_m, kSpacing_m)});
      !ok) {
    return ok;
  }
  if (config.serial_prefix.size() > kMaxPrefix) {
    return Error{ErrorCode::kInvalidArgument,
                 "simulator.serial_prefix must have at most 16 characters, has " +
                     std::to_string(config.serial_prefix.size())};
  }
  if (Status coils = Validate(config.coils); !coils) {
    return coils;
  }
  if (Status cameras = Validate(config.cameras); !cameras) {
    return cameras;
  }
  return Validate(config.faults);
}

}  // namespace limbcast::gateway
