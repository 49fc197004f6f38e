// What limbcast-fusion publishes is what `limbcast evaluate` computes: a recording goes through the
// real gateway, DDS and the real fusion service, and every orientation is compared with the offline
// one in all its bits. Two filters run side by side, so both slots are compared.
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/bus_factory.hpp"
#include "common/filters/filter_batches.hpp"
#include "common/filters/filter_factory.hpp"
#include "common/math/rotation.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/system/program.hpp"
#include "tools/limbcast/evaluate/orientation_trial.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

constexpr double kDeg = 3.14159265358979323846 / 180.0;
constexpr BodyId kTestBody{4711};  // of this test's probes; gateways number from 1
constexpr SensorUid kTestSensor{4711};
struct State {
  std::uint32_t sequence = 0;
  SensorUid sensor_uid;
  bool started = false;
  std::string filter;
  Eigen::Quaterniond q_earth_sensor;
};

// Stands in for the posture service towards a gateway that waits for it: answers what was heard
// with the time that it was of. So the gateway goes as fast as this test listens, and no faster.
class Acknowledger {
 public:
  explicit Acknowledger(bus::Bus& bus) : writer_(bus.MakeWriter<body::Skeleton>().value()) {
    thread_ = std::thread([this] { Run(); });
  }
  ~Acknowledger() {
    {
      const std::scoped_lock lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }
  Acknowledger(const Acknowledger&) = delete;
  Acknowledger& operator=(const Acknowledger&) = delete;

  void Heard(BodyId body_id, Time measured_at) {
    {
      const std::scoped_lock lock(mutex_);
      skeleton_.body_id = body_id;
      skeleton_.measured_at = measured_at;
      pending_ = true;
    }
    changed_.notify_one();
  }

 private:
  void Run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
      changed_.wait(lock, [this] { return stopping_ || pending_; });
      pending_ = false;
      const body::Skeleton skeleton = skeleton_;
      lock.unlock();
      static_cast<void>(writer_->Write(skeleton));
      writer_->Flush();
      lock.lock();
    }
  }

  std::unique_ptr<bus::Writer<body::Skeleton>> writer_;
  std::mutex mutex_;
  std::condition_variable changed_;
  body::Skeleton skeleton_;
  bool pending_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

// limbcast-fusion on a domain of its own, and everything it says from the first sample on.
class FusionOutputTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    domain_ = OwnDomain();
    shared_memory_before_ = SharedMemoryFiles();
  }

  // Starts the service and waits until samples reach it and its states reach us.
  void StartFusion(const std::vector<std::string>& settings) {
    std::vector<std::string> arguments = Line("limbcast-fusion");
    for (const std::string& setting : settings) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    fusion_ = Start(arguments);
    bus::BusConfig config;
    config.vendor = bus::ParseVendor(GetParam()).value();
    config.domain_id = domain_;
    bus_ = bus::Open(config).value();
    for (std::vector<State>& slot : states_) {
      slot.reserve(100'000);  // the listener's thread does not wait for memory
    }
    acknowledger_ = std::make_unique<Acknowledger>(*bus_);
    states_reader_ =
        bus_->MakeReader<body::SegmentState>(
                {.on_sample = [this](const body::SegmentState& s,
                                     const bus::SampleInfo&) { OnState(s); },
                 .on_disposed = [this](const body::SegmentState& key) { OnDisposed(key); }})
            .value();
    OpenTheWay();
  }

  // Link probes of a sensor of our own, until one is answered.
  void OpenTheWay() {
    roster_writer_ = bus_->MakeWriter<roster::RosterEntry>().value();
    marg_writer_ = bus_->MakeWriter<sensing::MargSample>().value();
    roster::RosterEntry entry;
    entry.body_id = kTestBody;
    entry.sensors = {{.sensor_uid = kTestSensor, .segment = body::Segment::kHead}};
    ASSERT_TRUE(roster_writer_->Write(entry).ok());
    sensing::MargSample probe;
    probe.sensor_uid = kTestSensor;
    probe.flags = sensing::kProbe;
    ASSERT_TRUE(Eventually(20s, [&] {
      EXPECT_TRUE(marg_writer_->Write(probe).ok());
      marg_writer_->Flush();
      const std::scoped_lock lock(mutex_);
      return answered_;
    })) << fusion_->Errors();
  }

  [[nodiscard]] std::vector<std::string> Line(const std::string& program) const {
    return {Program(program),        "--dds",       GetParam(), "--domain",
            std::to_string(domain_), "--log-level", "warning"};
  }
  [[nodiscard]] static std::unique_ptr<process::ChildProcess> Start(
      const std::vector<std::string>& arguments) {
    auto started = process::ChildProcess::Start({.arguments = arguments});
    EXPECT_TRUE(started.ok());
    return std::make_unique<process::ChildProcess>(std::move(*started));
  }

  void OnState(const body::SegmentState& state) {
    const std::scoped_lock lock(mutex_);
    if (state.body_id == kTestBody) {
      answered_ = true;
      return;
    }
    if (state.sequence != 0 && state.slot < 2) {  // 0: a probe of the gateway
      states_[state.slot].push_back(
          {state.sequence, state.sensor_uid, state.started, state.filter, state.q_earth_sensor});
    }
    if (state.slot == 1) {  // published after slot 0 of the same sample
      acknowledger_->Heard(state.body_id, state.measured_at);
    }
  }
  void OnDisposed(const body::SegmentState& key) {
    const std::scoped_lock lock(mutex_);
    slot_1_disposed_ = slot_1_disposed_ || key.slot == 1;
  }
  [[nodiscard]] std::vector<State> States(std::size_t slot) {
    const std::scoped_lock lock(mutex_);
    return states_[slot];
  }
  [[nodiscard]] std::size_t Count(std::size_t slot) {
    const std::scoped_lock lock(mutex_);
    return states_[slot].size();
  }

  // Asks for a filter until the service answers; asking twice for the same changes nothing.
  void Select(const std::string& text) {
    std::mutex mutex;
    std::vector<roster::CommandReply> replies;
    const auto reader =
        bus_->MakeReader<roster::CommandReply>(
                {.on_sample =
                     [&](const roster::CommandReply& reply, const bus::SampleInfo&) {
                       const std::scoped_lock lock(mutex);
                       replies.push_back(reply);
                     },
                 .on_disposed = {}})
            .value();
    const auto writer = bus_->MakeWriter<roster::Command>().value();
    roster::Command command;
    command.client_uid = 4711;
    command.kind = roster::CommandKind::kSelectFilter;
    command.text = text;
    ASSERT_TRUE(Eventually(10s, [&] {
      ++command.request_id;
      EXPECT_TRUE(writer->Write(command).ok());
      writer->Flush();
      const std::scoped_lock lock(mutex);
      return !replies.empty();
    })) << text;
    const std::scoped_lock lock(mutex);
    EXPECT_TRUE(replies.front().accepted) << replies.front().message;
  }

  // Ends the service; nothing of it is left.
  void StopFusion() {
    const process::ExitState ended = fusion_->Stop(10s);
    EXPECT_TRUE(ended.clean()) << ended.status << ' ' << ended.signal << fusion_->Errors();
    states_reader_.reset();
    acknowledger_.reset();
    roster_writer_.reset();
    marg_writer_.reset();
    bus_.reset();
    EXPECT_TRUE(ProcessesOnDomain(domain_).empty());
    EXPECT_EQ(SharedMemoryFiles(), shared_memory_before_);
  }

  std::uint32_t domain_ = 0;
  std::set<std::string> shared_memory_before_;
  std::unique_ptr<process::ChildProcess> fusion_;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<Acknowledger> acknowledger_;
  std::unique_ptr<bus::Reader<body::SegmentState>> states_reader_;
  std::unique_ptr<bus::Writer<roster::RosterEntry>> roster_writer_;
  std::unique_ptr<bus::Writer<sensing::MargSample>> marg_writer_;
  std::mutex mutex_;
  std::vector<State> states_[2];
  bool answered_ = false;
  bool slot_1_disposed_ = false;
};

bool SameBits(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return bits(a.w()) == bits(b.w()) && bits(a.x()) == bits(b.x()) && bits(a.y()) == bits(b.y()) &&
         bits(a.z()) == bits(b.z());
}

// Counts what differs and names the first, instead of one line for each of 45 000 samples.
void ExpectSame(const std::vector<State>& states, const tool::OrientationResult& offline) {
  SCOPED_TRACE(offline.filter);
  ASSERT_EQ(states.size(), offline.q_earth_sensor.size());
  std::size_t different = 0;
  std::size_t first = 0;
  for (std::size_t row = 0; row < states.size(); ++row) {
    const bool same = states[row].sequence == row + 1 && states[row].filter == offline.filter &&
                      SameBits(states[row].q_earth_sensor, offline.q_earth_sensor[row]);
    if (!same && different++ == 0) {
      first = row;
    }
  }
  EXPECT_EQ(different, 0U) << "first in row " << first << ": sample " << states[first].sequence
                           << ", " << states[first].filter << ", "
                           << states[first].q_earth_sensor.coeffs().transpose() << ", offline "
                           << offline.q_earth_sensor[first].coeffs().transpose();
}

TEST_P(FusionOutputTest, IsWhatEvaluateComputesSampleForSampleAndBitForBit) {
  constexpr const char* kTrial = "data/broad/35_disturbed_attached_magnet_4cm.hdf5";
  LIMBCAST_SKIP_WITHOUT_SHARED(kTrial);
  const std::filesystem::path path = *SharedPath(kTrial);
  ASSERT_NO_FATAL_FAILURE(StartFusion({"filter.name=bmf", "filter.beside=tqt"}));
  std::vector<std::string> arguments = Line("limbcast-gateway");
  arguments.insert(arguments.end(),
                   {"--recording", path.string(), "--speed", "max", "--wait-for", "posture",
                    "--exit-at-end", "--set", "gateway.answer_timeout_s=60"});
  const Outcome gateway = RunToEnd(arguments, 90s);
  ASSERT_EQ(gateway.status, 0) << Describe(gateway) << fusion_->Errors();

  const auto recording = gateway::ReadRecording(path);
  ASSERT_TRUE(recording.ok());
  const auto trials = tool::TrialsOf(*recording, path.stem().string());
  ASSERT_EQ(trials.size(), 1U);
  const std::size_t samples = trials[0].samples.size();
  ASSERT_GT(samples, 40'000U);
  EXPECT_TRUE(Eventually(10s, [&] { return Count(0) >= samples && Count(1) >= samples; }));
  for (const auto& [slot, name] : {std::pair{0U, "bmf"}, std::pair{1U, "tqt"}}) {
    auto filter = filters::MakeFilter(name);
    ASSERT_TRUE(filter.ok());
    const auto seated = filters::FilterBatches().Seat(std::move(*filter));
    ExpectSame(States(slot), tool::EvaluateTrial(trials[0], *seated));
  }
  StopFusion();
}

TEST_P(FusionOutputTest, FiltersAreSwitchedAndComparedWhileAPersonMoves) {
  ASSERT_NO_FATAL_FAILURE(StartFusion({}));
  std::vector<std::string> arguments = Line("limbcast-gateway");
  arguments.insert(arguments.end(), {"--wait-for", "fusion", "--set", "simulator.sensors=reduced15",
                                     "--set", "simulator.n_pose_s=0.5"});
  const auto gateway = Start(arguments);
  const auto last_is = [&](std::size_t slot, const char* filter) {
    return [this, slot, filter] {
      const std::scoped_lock lock(mutex_);
      return !states_[slot].empty() && states_[slot].back().filter == filter &&
             states_[slot].back().started;
    };
  };
  ASSERT_TRUE(Eventually(20s, last_is(0, "bmf"))) << gateway->Errors() << "the shipped filter";
  EXPECT_EQ(Count(1), 0U);
  ASSERT_NO_FATAL_FAILURE(Select("beside ckf"));
  ASSERT_TRUE(Eventually(10s, last_is(1, "ckf")));
  ASSERT_NO_FATAL_FAILURE(Select("tqt"));
  ASSERT_TRUE(Eventually(10s, last_is(0, "tqt")));
  ASSERT_NO_FATAL_FAILURE(Select("beside none"));
  EXPECT_TRUE(Eventually(10s, [&] {
    const std::scoped_lock lock(mutex_);
    return slot_1_disposed_;
  }));
  EXPECT_TRUE(gateway->Stop(10s).clean()) << gateway->Errors();

  // One sensor's story: every sample answered once, one change of filter, and no jump at it beyond
  // what the two may differ by (each is promised within 3 degrees of the truth).
  const std::vector<State> states = States(0);
  ASSERT_FALSE(states.empty());
  const SensorUid sensor = states.front().sensor_uid;
  std::vector<State> one;
  for (const State& state : states) {
    if (state.sensor_uid == sensor) {
      one.push_back(state);
    }
  }
  int changes = 0;
  for (std::size_t i = 1; i < one.size(); ++i) {
    ASSERT_EQ(one[i].sequence, one[i - 1].sequence + 1);
    if (one[i].filter != one[i - 1].filter) {
      ++changes;
      EXPECT_TRUE(one[i].started);
      EXPECT_LT(math::AngleBetween_rad(one[i].q_earth_sensor, one[i - 1].q_earth_sensor),
                6.0 * kDeg);
    }
  }
  EXPECT_EQ(changes, 1);
  StopFusion();
}

INSTANTIATE_TEST_SUITE_P(Dds, FusionOutputTest, ::testing::Values("cyclone", "fast"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace limbcast
