#include "tools/limbcast/json/value_json.hpp"

namespace limbcast::tool {

nlohmann::json VerdictsToJson(const VerdictCounters& verdicts) {
  nlohmann::json result = nlohmann::json::object();
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    if (verdicts.count[i] != 0) {
      result[std::string(ToString(static_cast<SampleVerdict>(i)))] = verdicts.count[i];
    }
  }
  return result;
}

nlohmann::json StagesToJson(const body::StageTimes& stages) {
  return {{"gateway_published_at", TimeToJson(stages.gateway_published_at)},
          {"fusion_received_at", TimeToJson(stages.fusion_received_at)},
          {"fusion_published_at", TimeToJson(stages.fusion_published_at)},
          {"posture_received_at", TimeToJson(stages.posture_received_at)},
          {"posture_published_at", TimeToJson(stages.posture_published_at)}};
}

std::string_view NameOf(MagneticState state) {
  switch (state) {
    case MagneticState::kUnused:
      return "unused";
    case MagneticState::kClean:
      return "clean";
    case MagneticState::kDisturbed:
      return "disturbed";
  }
  return "unknown";
}

std::string_view NameOf(HeadingReference heading) {
  switch (heading) {
    case HeadingReference::kArbitrary:
      return "arbitrary";
    case HeadingReference::kMagnetic:
      return "magnetic";
    case HeadingReference::kTrue:
      return "true";
  }
  return "unknown";
}

std::string_view NameOf(body::SegmentStatus status) {
  switch (status) {
    case body::SegmentStatus::kMissing:
      return "missing";
    case body::SegmentStatus::kTracked:
      return "tracked";
    case body::SegmentStatus::kStale:
      return "stale";
    case body::SegmentStatus::kFilled:
      return "filled";
  }
  return "unknown";
}

}  // namespace limbcast::tool
