#include "services/fusion/fusion_config.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "common/base/fnv1a.hpp"

namespace limbcast::fusion {

namespace {

constexpr std::size_t kMaxFilterNameLength = 16;  // bound of the wire type
constexpr double kMinFuture_s = 0.001;
constexpr double kMaxFuture_s = 1e9;
constexpr std::size_t kMaxPathLength = 4096;
constexpr double kMinPeriod_s = 0.1;
constexpr double kMaxPeriod_s = 3600.0;
constexpr double kMaxStateAge_s = 1e7;

FilterChoice ReadChoice(const config::Section& section, FilterChoice choice) {
  choice.name = section.Read("name", choice.name, kMaxFilterNameLength);
  choice.beside = section.Read("beside", choice.beside, kMaxFilterNameLength);
  return choice;
}

Status CheckFilter(const FilterFactory& factory, const std::string& name, const std::string& key) {
  if (const auto filter = factory(name); !filter) {
    return Error{filter.error().code, fmt::format("{}: {}", key, filter.error().message)};
  }
  return Ok();
}

Status CheckChoice(const FilterFactory& factory, const FilterChoice& choice,
                   const std::string& key) {
  if (Status made = CheckFilter(factory, choice.name, key + ".name"); !made) {
    return made;
  }
  return choice.beside.empty() ? Ok() : CheckFilter(factory, choice.beside, key + ".beside");
}

}  // namespace

FusionConfig ReadFusionConfig(const config::ConfigFile& file) {
  FusionConfig config;
  const config::Section fusion = file.Get("fusion");
  config.workers = fusion.Read("workers", config.workers, 1, 64);
  config.queue_capacity = fusion.Read("queue_capacity", config.queue_capacity, 64, 1U << 20U);
  config.max_future_s =
      fusion.Read("max_future_s", config.max_future_s, kMinFuture_s, kMaxFuture_s);
  config.declination_deg = fusion.Read("declination_deg", config.declination_deg, -180.0, 180.0);
  config.segment_frame = fusion.Read("segment_frame", config.segment_frame);
  config.state_dir = fusion.Read("state_dir", config.state_dir, kMaxPathLength);
  config.state_period_s =
      fusion.Read("state_period_s", config.state_period_s, kMinPeriod_s, kMaxPeriod_s);
  config.state_max_age_s =
      fusion.Read("state_max_age_s", config.state_max_age_s, 0.0, kMaxStateAge_s);
  config.position = ReadPositionConfig(fusion);

  const config::Section filter = file.Get("filter");
  config.filter = ReadChoice(filter, config.filter);
  const config::Section segments = filter.Get("segment");
  for (const std::string& name : segments.Keys()) {
    const config::Section section = segments.Get(name);
    if (const auto segment = body::ParseSegment(name)) {
      config.segment_filters[*segment] = ReadChoice(section, config.filter);
    } else {
      segments.Fail(name, "is not a segment; those are pelvis, l5, ..., see common/body/README.md");
    }
  }
  const config::Section settings = filter.Get("settings");
  for (const std::string& name : settings.Keys()) {
    const config::Section section = settings.Get(name);
    for (const std::string& key : section.Keys()) {
      config.filter_settings[name].emplace_back(key, section.ReadAnyAsText(key));
    }
    if (const auto made = filters::MakeFilter(name, config.filter_settings[name]); !made) {
      settings.Fail(name, made.error().message);
    }
  }
  return config;
}

std::uint64_t FilterSettingsNumber(const FusionConfig& config) {
  std::uint64_t hash = kFnv1aBasis;
  const auto add = [&hash](std::string_view text) {
    hash = Fnv1a(Fnv1a(hash, text), std::uint8_t{0xff});  // an end that no text has
  };
  for (const auto& [filter, settings] : config.filter_settings) {
    add(filter);
    for (const auto& [key, value] : settings) {
      add(key);
      add(value);
    }
  }
  return hash;
}

FilterFactory MakeFilterFactory(const FusionConfig& config) {
  return [settings = config.filter_settings](std::string_view name) {
    const auto found = settings.find(name);
    return found == settings.end() ? filters::MakeFilter(name)
                                   : filters::MakeFilter(name, found->second);
  };
}

Status Validate(const FusionConfig& config, const FilterFactory& factory) {
  const auto refuse = [](std::string message) {
    return Status(Error{ErrorCode::kInvalidArgument, std::move(message)});
  };
  if (config.workers < 1 || config.workers > 64) {
    return refuse(fmt::format("fusion.workers must be in [1, 64], is {}", config.workers));
  }
  if (config.queue_capacity < 64 || config.queue_capacity > (1U << 20U)) {
    return refuse(fmt::format("fusion.queue_capacity must be in [64, 1048576], is {}",
                              config.queue_capacity));
  }
  if (!(config.max_future_s >= kMinFuture_s && config.max_future_s <= kMaxFuture_s)) {
    return refuse(
        fmt::format("fusion.max_future_s must be in [0.001, 1e9], is {}", config.max_future_s));
  }
  if (!(std::abs(config.declination_deg) <= 180.0)) {
    return refuse(fmt::format("fusion.declination_deg must be in [-180, 180], is {}",
                              config.declination_deg));
  }
  if (!(config.state_period_s >= kMinPeriod_s && config.state_period_s <= kMaxPeriod_s)) {
    return refuse(
        fmt::format("fusion.state_period_s must be in [0.1, 3600], is {}", config.state_period_s));
  }
  if (!(config.state_max_age_s >= 0.0 && config.state_max_age_s <= kMaxStateAge_s)) {
    return refuse(
        fmt::format("fusion.state_max_age_s must be in [0, 1e7], is {}", config.state_max_age_s));
  }
  if (Status valid = Validate(config.position); !valid) {
    return valid;
  }
  if (Status made = CheckChoice(factory, config.filter, "filter"); !made) {
    return made;
  }
  for (const auto& [segment, choice] : config.segment_filters) {
    const std::string key = fmt::format("filter.segment.{}", body::ToString(segment));
    if (Status made = CheckChoice(factory, choice, key); !made) {
      return made;
    }
  }
  return Ok();
}

}  // namespace limbcast::fusion
