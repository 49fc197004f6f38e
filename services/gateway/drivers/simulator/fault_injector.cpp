#include "services/gateway/drivers/simulator/fault_injector.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

namespace limbcast::gateway {
namespace {

constexpr std::array<std::pair<std::string_view, Fault>, kFaultCount> kNames = {{
    {"not_finite", Fault::kNotFinite},
    {"saturated", Fault::kSaturated},
    {"duplicate", Fault::kDuplicate},
    {"out_of_order", Fault::kOutOfOrder},
    {"gap", Fault::kGap},
    {"mag_missing", Fault::kMagMissing},
}};

}  // namespace

std::span<const std::pair<std::string_view, Fault>> FaultNames() { return kNames; }

Status Validate(const FaultConfig& config) {
  const auto in_range = [](double rate) { return rate >= 0.0 && rate <= 1.0; };
  for (const auto& [name, fault] : kNames) {
    if (const double rate = config.rate[static_cast<std::size_t>(fault)]; !in_range(rate)) {
      return Error{
          ErrorCode::kInvalidArgument,
          "faults." + std::string(name) + "_rate must be in [0, 1], is " + std::to_string(rate)};
    }
  }
  const double sum = std::accumulate(config.rate.begin(), config.rate.end(), 0.0);
  if (sum > 1.0) {
    return Error{ErrorCode::kInvalidArgument,
                 "faults: all rates together must be at most 1, are " + std::to_string(sum)};
  }
  if (config.gap_ticks < 1 || config.gap_ticks > 100'000) {
    return Error{ErrorCode::kInvalidArgument,
                 "faults.gap_ticks must be in [1, 100000], is " + std::to_string(config.gap_ticks)};
  }
  return Ok();
}

FaultInjector::FaultInjector(const FaultConfig& config, std::uint32_t body, body::Segment segment,
                             const sensing::SensorInfo& info, const simulation::Random& random)
    : config_(config), info_(info), random_(random) {
  std::erase_if(config_.list, [&](const ListedFault& listed) {
    return listed.body != body || listed.segment != segment;
  });
  std::stable_sort(config_.list.begin(), config_.list.end(),
                   [](const ListedFault& a, const ListedFault& b) { return a.tick < b.tick; });
  any_ = !config_.list.empty() || std::any_of(config_.rate.begin(), config_.rate.end(),
                                              [](double rate) { return rate > 0.0; });
}

std::optional<Fault> FaultInjector::Draw(std::uint64_t tick) {
  double draw = random_.Uniform();  // one for every sample, listed or not: lists do not shift it
  while (next_listed_ < config_.list.size() && config_.list[next_listed_].tick < tick) {
    ++next_listed_;
  }
  if (next_listed_ < config_.list.size() && config_.list[next_listed_].tick == tick) {
    return config_.list[next_listed_].fault;
  }
  for (std::size_t i = 0; i < kFaultCount; ++i) {
    if (draw < config_.rate[i]) {
      return static_cast<Fault>(i);
    }
    draw -= config_.rate[i];
  }
  return std::nullopt;
}

void FaultInjector::Pass(std::uint64_t tick, const sensing::MargSample& sample,
                         std::vector<sensing::MargSample>& out) {
  if (!any_) {
    out.push_back(sample);
    return;
  }
  std::optional<Fault> fault = Draw(tick);
  if (gap_left_ > 0) {
    fault = Fault::kGap;
  } else if (fault == Fault::kGap) {
    gap_left_ = config_.gap_ticks;
  } else if (fault == Fault::kOutOfOrder && held_) {
    fault.reset();  // one at a time
  }
  if (fault) {
    ++counts_[static_cast<std::size_t>(*fault)];
  }
  in_gap_ = fault == Fault::kGap;
  if (in_gap_) {
    --gap_left_;
    return;
  }
  if (fault == Fault::kOutOfOrder) {
    held_ = sample;
    return;
  }
  sensing::MargSample bad = sample;
  if (fault == Fault::kNotFinite) {
    if (counts_[static_cast<std::size_t>(Fault::kNotFinite)] % 2 == 1) {
      bad.gyro_rad_s.y() = std::numeric_limits<float>::quiet_NaN();
    } else {
      bad.accel_m_s2.z() = std::numeric_limits<float>::infinity();
    }
  } else if (fault == Fault::kSaturated) {
    bad.gyro_rad_s.setConstant(info_.gyro_range_rad_s);
    bad.accel_m_s2.setConstant(-info_.accel_range_m_s2);
    bad.flags |= sensing::kGyroSaturated | sensing::kAccelSaturated;
  } else if (fault == Fault::kMagMissing) {
    bad.mag_tesla.setZero();
    bad.flags |= sensing::kMagMissing;
  }
  out.push_back(bad);
  if (fault == Fault::kDuplicate) {
    out.push_back(bad);
  }
  if (held_) {
    out.push_back(*held_);
    held_.reset();
  }
}

}  // namespace limbcast::gateway
