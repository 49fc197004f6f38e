#include "services/gateway/sample_publisher.hpp"

#include <utility>

namespace limbcast::gateway {

namespace {

constexpr std::uint32_t kAllMissing = sensing::kGyroMissing | sensing::kAccelMissing |
                                      sensing::kMagMissing | sensing::kTemperatureMissing;

// False for NaN: that is for the fusion service to judge.
bool AtLimit(const Eigen::Vector3f& reading, float limit) {
  return limit > 0.0F && (reading.array().abs() >= limit).any();
}

// Numbers go on from 1 after 2^32 samples: 0 means "not numbered".
std::uint32_t NextSequence(std::uint32_t& sequence) {
  sequence += sequence + 1 == 0 ? 2U : 1U;
  return sequence;
}

}  // namespace

SamplePublisher::SamplePublisher(const GatewayConfig& config, const DriverDescription& description,
                                 const Clock& clock)
    : marg_frame_(config.marg_frame),
      publish_roster_(config.publish_roster && !config.session_host),
      publish_truth_(config.publish_truth),
      clock_(clock) {
  for (const sensing::SensorInfo& info : description.sensors) {
    SensorStream& stream = streams_[StreamOf(info.sensor_uid)];
    stream.label = info.label.empty() ? info.serial : info.label;
    stream.gyro_limit_rad_s = kSaturatedShare * info.gyro_range_rad_s;
    stream.accel_limit_m_s2 = kSaturatedShare * info.accel_range_m_s2;
    stream.mag_limit_tesla = kSaturatedShare * info.mag_range_tesla;
  }
  for (std::size_t body = 0; body < description.bodies.size(); ++body) {
    frames_.emplace_back();
    frames_.back().body_id = description.bodies[body].body_id;
    frames_.back().gateway = config.gateway_id;
    for (const roster::SensorAssignment& assignment : description.bodies[body].sensors) {
      streams_[StreamOf(assignment.sensor_uid)].body = static_cast<std::int32_t>(body);
    }
  }
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (streams_[i].body >= 0 || !publish_roster_) {
      sensing::MargSample probe;
      probe.sensor_uid = streams_[i].uid;
      probe.flags = sensing::kProbe | kAllMissing;
      probes_.push_back(probe);
      probe_streams_.push_back(i);
    }
  }
}

template <typename T>
Status SamplePublisher::MakeWriter(bus::Bus& bus, std::unique_ptr<bus::Writer<T>>& writer) {
  Result<std::unique_ptr<bus::Writer<T>>> made = bus.MakeWriter<T>();
  if (!made) {
    return made.error();
  }
  writer = std::move(*made);
  return Ok();
}

Result<std::unique_ptr<SamplePublisher>> SamplePublisher::Make(const GatewayConfig& config,
                                                               const DriverDescription& description,
                                                               const Clock& clock, bus::Bus& bus) {
  std::unique_ptr<SamplePublisher> publisher(new SamplePublisher(config, description, clock));
  Status made = MakeWriter(bus, publisher->marg_writer_);
  made = made ? MakeWriter(bus, publisher->frame_writer_) : made;
  made = made ? MakeWriter(bus, publisher->orientation_writer_) : made;
  made = made ? MakeWriter(bus, publisher->marker_writer_) : made;
  made = made ? MakeWriter(bus, publisher->burst_writer_) : made;
  made = made ? MakeWriter(bus, publisher->truth_writer_) : made;
  made = made ? MakeWriter(bus, publisher->info_writer_) : made;
  made = made ? MakeWriter(bus, publisher->roster_writer_) : made;
  if (!made) {
    return made.error();
  }
  return publisher;
}

std::size_t SamplePublisher::StreamOf(SensorUid uid) {
  const auto [entry, is_new] = stream_of_.try_emplace(uid, streams_.size());
  if (is_new) {  // after the start: a driver that did not describe all its sensors
    streams_.emplace_back();
    streams_.back().uid = uid;
  }
  return entry->second;
}

Status SamplePublisher::Announce(const DriverDescription& description) {
  for (const sensing::SensorInfo& info : description.sensors) {
    if (Status written = info_writer_->Write(info); !written) {
      return written;
    }
  }
  info_writer_->Flush();
  if (!publish_roster_) {
    return Ok();
  }
  for (const roster::RosterEntry& entry : description.bodies) {
    if (Status written = roster_writer_->Write(entry); !written) {
      return written;
    }
  }
  roster_writer_->Flush();
  return Ok();
}

void SamplePublisher::Withdraw(const DriverDescription& description) {
  for (const sensing::SensorInfo& info : description.sensors) {
    if (const Status disposed = info_writer_->Dispose(info); !disposed) {
      ++counters_.write_errors;
      last_error_ = disposed.error().message;
    }
  }
  info_writer_->Flush();
}

void SamplePublisher::FlagSaturation(const SensorStream& stream, sensing::MargSample& sample) {
  std::uint32_t saturated = 0;
  if (!sample.Has(sensing::kGyroMissing) && AtLimit(sample.gyro_rad_s, stream.gyro_limit_rad_s)) {
    saturated |= sensing::kGyroSaturated;
  }
  if (!sample.Has(sensing::kAccelMissing) && AtLimit(sample.accel_m_s2, stream.accel_limit_m_s2)) {
    saturated |= sensing::kAccelSaturated;
  }
  if (!sample.Has(sensing::kMagMissing) && AtLimit(sample.mag_tesla, stream.mag_limit_tesla)) {
    saturated |= sensing::kMagSaturated;
  }
  sample.flags |= saturated;
  counters_.saturated += saturated != 0 ? 1U : 0U;
}

void SamplePublisher::Stamp(Batch& batch) {
  marg_streams_.clear();
  for (sensing::MargSample& sample : batch.marg) {
    marg_streams_.push_back(StreamOf(sample.sensor_uid));
    SensorStream& stream = streams_[marg_streams_.back()];
    sample.sequence = NextSequence(stream.marg_sequence);
    FlagSaturation(stream, sample);
    counters_.mag_missing += sample.Has(sensing::kMagMissing) ? 1U : 0U;
  }
  orientation_streams_.clear();
  for (sensing::FusedOrientation& sample : batch.orientation) {
    orientation_streams_.push_back(StreamOf(sample.sensor_uid));
    sample.sequence = NextSequence(streams_[orientation_streams_.back()].orientation_sequence);
  }
  counters_.marg += batch.marg.size();
  counters_.orientation += batch.orientation.size();
  counters_.markers += batch.markers.size();
  counters_.coil_bursts += batch.coil_bursts.size();
  counters_.truth += publish_truth_ ? batch.truth.size() : 0U;
}

template <typename T>
void SamplePublisher::Send(bus::Writer<T>& writer, const T& value) {
  if (const Status written = writer.Write(value); !written) {
    ++counters_.write_errors;
    last_error_ = written.error().message;
  }
}

template <typename T>
void SamplePublisher::SendAll(bus::Writer<T>& writer, std::vector<T>& values) {
  if (values.empty()) {
    return;
  }
  for (T& value : values) {
    value.published_at = clock_.Now();
    Send(writer, value);
  }
  writer.Flush();
}

void SamplePublisher::WriteMarg(std::vector<sensing::MargSample>& samples,
                                const std::vector<std::size_t>& streams) {
  if (marg_frame_) {
    WriteFrames(samples, streams);
    return;
  }
  for (sensing::MargSample& sample : samples) {
    sample.published_at = clock_.Now();
    Send(*marg_writer_, sample);
  }
  marg_writer_->Flush();
}

void SamplePublisher::SendFrame(sensing::MargFrame& frame) {
  if (frame.samples.empty()) {
    return;
  }
  const Time now = clock_.Now();
  for (sensing::MargSample& sample : frame.samples) {
    sample.published_at = now;
  }
  Send(*frame_writer_, frame);
  frame.samples.clear();
}

// Samples of sensors that nobody wears belong into no frame: they go one by one.
void SamplePublisher::WriteFrames(std::vector<sensing::MargSample>& samples,
                                  const std::vector<std::size_t>& streams) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::int32_t body = streams_[streams[i]].body;
    if (body < 0) {
      samples[i].published_at = clock_.Now();
      Send(*marg_writer_, samples[i]);
      continue;
    }
    sensing::MargFrame& frame = frames_[static_cast<std::size_t>(body)];
    frame.samples.push_back(samples[i]);
    if (frame.samples.size() == sensing::kMaxSamplesPerFrame) {
      SendFrame(frame);
    }
  }
  for (sensing::MargFrame& frame : frames_) {
    SendFrame(frame);
  }
  frame_writer_->Flush();
  marg_writer_->Flush();
}

void SamplePublisher::Write(Batch& batch) {
  SendAll(*marker_writer_, batch.markers);
  if (!batch.marg.empty()) {
    WriteMarg(batch.marg, marg_streams_);
  }
  SendAll(*orientation_writer_, batch.orientation);
  SendAll(*burst_writer_, batch.coil_bursts);
  if (publish_truth_ && !batch.truth.empty()) {
    for (const body::SegmentTruth& truth : batch.truth) {
      Send(*truth_writer_, truth);
    }
    truth_writer_->Flush();
  }
}

void SamplePublisher::WriteProbes(Time measured_at) {
  for (sensing::MargSample& probe : probes_) {
    probe.measured_at = measured_at;
  }
  WriteMarg(probes_, probe_streams_);
}

bool SamplePublisher::HasReaders() const {
  const std::int32_t marg_readers =
      marg_frame_ ? frame_writer_->counters().matched : marg_writer_->counters().matched;
  return marg_readers > 0 && orientation_writer_->counters().matched > 0;
}

}  // namespace limbcast::gateway
