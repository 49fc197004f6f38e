#pragma once

#include <atomic>
#include <chrono>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "common/bus/endpoint_events.hpp"
#include "common/bus/fastdds/fast_participant.hpp"
#include "common/bus/fastdds/fast_qos.hpp"
#include "common/bus/fastdds/fast_type.hpp"
#include "common/bus/reader.hpp"
#include "common/bus/system_now.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"

namespace limbcast::bus::fastdds {

/// Reads T through one Fast DDS DataReader and calls the handler on the library's receiving thread.
template <typename T>
class FastReader final : public Reader<T>, private eprosima::fastdds::dds::DataReaderListener {
 public:
  FastReader(FastParticipant& participant, ReaderHandler<T> handler)
      : participant_(participant),
        events_(Topic<T>::kShortName, false, participant.sink()),
        handler_(std::move(handler)) {}
  ~FastReader() override {
    {
      const std::lock_guard lock(mutex_);  // waits for a handler that runs now
      closed_ = true;
    }
    if (reader_ != nullptr) {
      participant_.subscriber().delete_datareader(reader_);
    }
  }
  FastReader(const FastReader&) = delete;
  FastReader& operator=(const FastReader&) = delete;

  [[nodiscard]] Status Open() {
    namespace dds = eprosima::fastdds::dds;
    const auto topic = participant_.TopicOf(Topic<T>::kName, Topic<T>::kShortName,
                                            dds::TypeSupport(new FastType<T>()));
    if (!topic) {
      return topic.error();
    }
    const auto qos =
        ReaderQos(Topic<T>::kProfile, Topic<T>::kExclusiveOwnership, participant_.config());
    reader_ =
        participant_.subscriber().create_datareader(*topic, qos, this, dds::StatusMask::all());
    if (reader_ == nullptr) {
      return Error{ErrorCode::kUnavailable,
                   "Fast DDS refuses a reader of " + std::string(Topic<T>::kName)};
    }
    return Ok();
  }

  [[nodiscard]] EndpointCounters counters() const override { return events_.counters(); }

 private:
  using Code = eprosima::fastrtps::types::ReturnCode_t;
  using DataReader = eprosima::fastdds::dds::DataReader;
  using Handle = eprosima::fastdds::dds::InstanceHandle_t;

  void on_data_available(DataReader* reader) override {
    const std::lock_guard lock(mutex_);
    eprosima::fastdds::dds::SampleInfo info;
    while (!closed_ && reader->take_next_sample(&sample_, &info) == Code::RETCODE_OK) {
      if (info.valid_data) {
        Deliver(info);
      } else if (IsDisposal(info)) {
        DeliverDisposed(info.instance_handle);
      }
    }
  }

  // The library (2.9) does not see that an instance is disposed of whose writer has gone. Nobody
  // but an owner that says good-bye unregisters without disposing, and owners only from what they
  // wrote themselves.
  [[nodiscard]] bool IsDisposal(const eprosima::fastdds::dds::SampleInfo& info) const {
    if (info.instance_state != eprosima::fastdds::dds::NOT_ALIVE_NO_WRITERS_INSTANCE_STATE) {
      return info.instance_state == eprosima::fastdds::dds::NOT_ALIVE_DISPOSED_INSTANCE_STATE;
    }
    const auto known = known_.find(info.instance_handle);
    return known != known_.end() &&
           (!Topic<T>::kExclusiveOwnership || known->second != info.publication_handle);
  }

  void Deliver(const eprosima::fastdds::dds::SampleInfo& info) {
    if (sample_.malformed) {
      events_.Malformed("bytes that are no " + std::string(Codec<T>::kTypeName));
      return;
    }
    if (const Status decoded = Codec<T>::Decode(sample_.wire, value_); !decoded) {
      events_.Malformed(decoded.error().message);
      return;
    }
    known_.insert_or_assign(info.instance_handle, info.publication_handle);
    events_.Sample();
    if (handler_.on_sample) {
      handler_.on_sample(value_, {.received_at = SystemNow()});
    }
  }

  // A dispose comes without data, and the library cannot tell the key of a handle. The handle is
  // the key, though: big-endian and at most 16 bytes. Instances never seen are nobody's business.
  void DeliverDisposed(const Handle& handle) {
    if (known_.erase(handle) == 0) {
      return;
    }
    Codec<T>::FromKeyHash(KeyOf(handle), sample_.wire);
    if (!Codec<T>::DecodeKey(sample_.wire, value_)) {
      return;  // cannot be: a good sample had this key
    }
    events_.Disposed();
    if (handler_.on_disposed) {
      handler_.on_disposed(value_);
    }
  }

  void on_subscription_matched(
      DataReader* /*reader*/,
      const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override {
    if (status.current_count_change > 0) {
      joined_at_ = std::chrono::steady_clock::now();
    }
    events_.Matched(status.current_count_change, status.current_count);
  }
  void on_liveliness_changed(DataReader* /*reader*/,
                             const eprosima::fastrtps::LivelinessChangedStatus& status) override {
    events_.Liveliness(status.alive_count, status.not_alive_count);
  }
  void on_requested_incompatible_qos(
      DataReader* /*reader*/,
      const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override {
    events_.IncompatibleQos(status.total_count_change, PolicyName(status.last_policy_id));
  }
  void on_sample_lost(DataReader* /*reader*/,
                      const eprosima::fastdds::dds::SampleLostStatus& status) override {
    // A writer that knew us before we knew it counts what it sent in between as ours. It is not.
    if (std::chrono::steady_clock::now() - joined_at_.load() > kJoining) {
      events_.Lost(status.total_count_change);
    }
  }
  void on_sample_rejected(DataReader* /*reader*/,
                          const eprosima::fastrtps::SampleRejectedStatus& status) override {
    events_.Rejected(status.total_count_change, "resource limits of the reader");
  }

  static constexpr std::chrono::seconds kJoining{1};

  FastParticipant& participant_;
  EndpointEvents events_;
  ReaderHandler<T> handler_;
  std::atomic<std::chrono::steady_clock::time_point> joined_at_{};  // the last writer
  std::mutex mutex_;  // one call of the handler at a time; guards what follows
  bool closed_ = false;
  FastSample<T> sample_;
  T value_;
  // Instances that the handler has seen and that were not disposed of, and who wrote them last.
  std::map<Handle, Handle> known_;
  DataReader* reader_ = nullptr;
};

}  // namespace limbcast::bus::fastdds
