#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"

namespace limbcast::gateway::test {

/// What stands behind a gateway in its tests: keeps what comes and, if told to, answers as fusion
/// and posture do (a state for each sample, a skeleton for each state).
class FakePipeline {
 public:
  explicit FakePipeline(bus::Bus& bus) {
    state_writer_ = Take(bus.MakeWriter<body::SegmentState>());
    skeleton_writer_ = Take(bus.MakeWriter<body::Skeleton>());
    marg_reader_ = Take(bus.MakeReader<sensing::MargSample>(
        {.on_sample = [this](const auto& sample, const auto&) { OnMarg(sample); },
         .on_disposed = {}}));
    frame_reader_ =
        Take(bus.MakeReader<sensing::MargFrame>({.on_sample =
                                                     [this](const auto& frame, const auto&) {
                                                       ++frames;
                                                       frame_bodies.push_back(frame.body_id);
                                                       for (const auto& sample : frame.samples) {
                                                         OnMarg(sample);
                                                       }
                                                     },
                                                 .on_disposed = {}}));
    orientation_reader_ = Take(bus.MakeReader<sensing::FusedOrientation>(
        {.on_sample =
             [this](const auto& sample, const auto&) {
               orientations.push_back(sample);
               Answer(sample.sensor_uid, sample.sequence, sample.measured_at);
             },
         .on_disposed = {}}));
    marker_reader_ = Take(bus.MakeReader<sensing::MarkerPosition>(
        {.on_sample =
             [this](const auto& marker, const auto&) {
               markers.push_back(marker);
               samples_before_marker.push_back(samples.size());
             },
         .on_disposed = {}}));
    burst_reader_ = Take(bus.MakeReader<sensing::CoilBurst>(
        {.on_sample = [this](const auto& burst, const auto&) { bursts.push_back(burst); },
         .on_disposed = {}}));
    truth_reader_ = Take(bus.MakeReader<body::SegmentTruth>(
        {.on_sample = [this](const auto& truth, const auto&) { truths.push_back(truth); },
         .on_disposed = {}}));
    info_reader_ = Take(bus.MakeReader<sensing::SensorInfo>(
        {.on_sample = [this](const auto& info, const auto&) { infos.push_back(info); },
         .on_disposed = [this](const auto&) { ++infos_disposed; }}));
    roster_reader_ = Take(bus.MakeReader<roster::RosterEntry>(
        {.on_sample = [this](const auto& entry, const auto&) { entries.push_back(entry); },
         .on_disposed = {}}));
  }

  bool fusion_answers = false;
  bool posture_answers = false;
  std::uint32_t swallow_sequence = 0;  ///< this one gets no answer
  std::uint32_t dies_after =
      std::numeric_limits<std::uint32_t>::max();  ///< no answer to later ones

  std::vector<sensing::MargSample> samples;  ///< without probes
  std::vector<sensing::MargSample> probes;
  std::vector<sensing::FusedOrientation> orientations;
  std::vector<sensing::MarkerPosition> markers;
  std::vector<std::size_t> samples_before_marker;
  std::vector<sensing::CoilBurst> bursts;
  std::vector<body::SegmentTruth> truths;
  std::vector<sensing::SensorInfo> infos;
  std::vector<roster::RosterEntry> entries;
  std::vector<BodyId> frame_bodies;
  int frames = 0;
  int infos_disposed = 0;

  /// Samples of one sensor, in the order of arrival.
  [[nodiscard]] std::vector<sensing::MargSample> Of(SensorUid uid) const {
    std::vector<sensing::MargSample> found;
    for (const sensing::MargSample& sample : samples) {
      if (sample.sensor_uid == uid) {
        found.push_back(sample);
      }
    }
    return found;
  }

 private:
  template <typename T>
  static T Take(Result<T> result) {
    return std::move(result).value();
  }

  void OnMarg(const sensing::MargSample& sample) {
    (sample.Has(sensing::kProbe) ? probes : samples).push_back(sample);
    Answer(sample.sensor_uid, sample.sequence, sample.measured_at);
  }

  void Answer(SensorUid uid, std::uint32_t sequence, Time measured_at) {
    if (fusion_answers && (sequence == 0 || sequence != swallow_sequence) &&
        sequence <= dies_after) {
      body::SegmentState state;
      state.body_id = BodyId{1};
      state.segment = static_cast<body::Segment>(uid.value - 1);
      state.sensor_uid = uid;
      state.sequence = sequence;
      state.measured_at = measured_at;
      static_cast<void>(state_writer_->Write(state));
    }
    if (posture_answers) {
      body::Skeleton skeleton;
      skeleton.body_id = BodyId{1};
      skeleton.measured_at = measured_at;
      static_cast<void>(skeleton_writer_->Write(skeleton));
    }
  }

  std::unique_ptr<bus::Writer<body::SegmentState>> state_writer_;
  std::unique_ptr<bus::Writer<body::Skeleton>> skeleton_writer_;
  std::unique_ptr<bus::Reader<sensing::MargSample>> marg_reader_;
  std::unique_ptr<bus::Reader<sensing::MargFrame>> frame_reader_;
  std::unique_ptr<bus::Reader<sensing::FusedOrientation>> orientation_reader_;
  std::unique_ptr<bus::Reader<sensing::MarkerPosition>> marker_reader_;
  std::unique_ptr<bus::Reader<sensing::CoilBurst>> burst_reader_;
  std::unique_ptr<bus::Reader<body::SegmentTruth>> truth_reader_;
  std::unique_ptr<bus::Reader<sensing::SensorInfo>> info_reader_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> roster_reader_;
};

}  // namespace limbcast::gateway::test
