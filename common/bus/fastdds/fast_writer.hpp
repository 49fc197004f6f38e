#pragma once

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <mutex>
#include <set>
#include <string>

#include "common/bus/endpoint_events.hpp"
#include "common/bus/fastdds/fast_participant.hpp"
#include "common/bus/fastdds/fast_qos.hpp"
#include "common/bus/fastdds/fast_type.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"
#include "common/bus/writer.hpp"

namespace limbcast::bus::fastdds {

/// Writes T through one Fast DDS DataWriter. Thread-safe.
template <typename T>
class FastWriter final : public Writer<T>, private eprosima::fastdds::dds::DataWriterListener {
 public:
  explicit FastWriter(FastParticipant& participant)
      : participant_(participant), events_(Topic<T>::kShortName, true, participant.sink()) {}
  ~FastWriter() override {
    if (writer_ != nullptr) {
      UnregisterAll();
      // The news that a writer is gone travels on another socket and may overtake its last samples,
      // which the reader then drops. (Cyclone DDS waits like this by itself.)
      writer_->wait_for_acknowledgments(kLinger);
      // The library (2.9) frees what an unanswering reader left here while its heartbeat may still
      // look at it, and then counts from nothing to the end of it (RTPSWriter::deinit,
      // StatefulWriter::add_gaps_for_holes_in_history_): no process would end.
      writer_->clear_history(nullptr);
      participant_.publisher().delete_datawriter(writer_);
    }
  }
  FastWriter(const FastWriter&) = delete;
  FastWriter& operator=(const FastWriter&) = delete;

  [[nodiscard]] Status Open() {
    namespace dds = eprosima::fastdds::dds;
    const auto topic = participant_.TopicOf(Topic<T>::kName, Topic<T>::kShortName,
                                            dds::TypeSupport(new FastType<T>()));
    if (!topic) {
      return topic.error();
    }
    const auto qos =
        WriterQos(Topic<T>::kProfile, Topic<T>::kExclusiveOwnership, participant_.config());
    writer_ = participant_.publisher().create_datawriter(*topic, qos, this, dds::StatusMask::all());
    if (writer_ == nullptr) {
      return Error{ErrorCode::kUnavailable,
                   "Fast DDS refuses a writer of " + std::string(Topic<T>::kName)};
    }
    return Ok();
  }

  [[nodiscard]] Status Write(const T& value) override {
    const std::lock_guard lock(mutex_);
    if (Status encoded = Codec<T>::Encode(value, sample_.wire); !encoded) {
      return encoded;
    }
    const Code code = writer_->write(&sample_, eprosima::fastdds::dds::HANDLE_NIL);
    if (code != Code::RETCODE_OK) {
      return Failed("write", code);
    }
    if constexpr (Topic<T>::kExclusiveOwnership) {
      written_.insert(Codec<T>::HashKey(sample_.wire));
    }
    events_.Sample();
    return Ok();
  }

  [[nodiscard]] Status Dispose(const T& key) override {
    const std::lock_guard lock(mutex_);
    Codec<T>::EncodeKey(key, sample_.wire);
    writer_->register_instance(&sample_);  // it may have been written before a restart
    // Disposes, too (WriterQos): a reader of Fast DDS 2.9 asserts that a writer which is still
    // registered with a disposed instance was alive before, and ends its process when that writer
    // only followed one that died.
    const Code code = writer_->unregister_instance(&sample_, eprosima::fastdds::dds::HANDLE_NIL);
    written_.erase(Codec<T>::HashKey(sample_.wire));
    return code == Code::RETCODE_OK ? Ok() : Failed("dispose", code);
  }

  void Flush() override {}  // nothing is held back
  [[nodiscard]] EndpointCounters counters() const override { return events_.counters(); }

 private:
  using Code = eprosima::fastrtps::types::ReturnCode_t;
  using DataWriter = eprosima::fastdds::dds::DataWriter;

  // A reader that died does not answer: do not wait for it for long.
  static inline const eprosima::fastrtps::Duration_t kLinger{0, 300'000'000};

  static Status Failed(const char* what, const Code& code) {
    const std::string where = std::string(what) + " " + std::string(Topic<T>::kName) + ": ";
    if (code == Code::RETCODE_TIMEOUT) {
      return Error{ErrorCode::kTimeout, where + "readers did not make room in 100 ms"};
    }
    return Error{ErrorCode::kUnavailable, where + "Fast DDS return code " + std::to_string(code())};
  }

  // A weaker writer takes over at once when the owner says good-bye to its instances, without
  // disposing of them.
  void UnregisterAll() {
    if (written_.empty()) {
      return;
    }
    auto qos = writer_->get_qos();
    qos.writer_data_lifecycle().autodispose_unregistered_instances = false;
    writer_->set_qos(qos);
    for (const KeyHash& key : written_) {
      Codec<T>::FromKeyHash(key, sample_.wire);
      writer_->unregister_instance(&sample_, eprosima::fastdds::dds::HANDLE_NIL);
    }
  }

  void on_publication_matched(
      DataWriter* /*writer*/,
      const eprosima::fastdds::dds::PublicationMatchedStatus& status) override {
    events_.Matched(status.current_count_change, status.current_count);
  }
  void on_offered_incompatible_qos(
      DataWriter* /*writer*/,
      const eprosima::fastdds::dds::OfferedIncompatibleQosStatus& status) override {
    events_.IncompatibleQos(status.total_count_change, PolicyName(status.last_policy_id));
  }

  FastParticipant& participant_;
  EndpointEvents events_;
  std::mutex mutex_;  // guards the next two and keeps samples in the order of the calls
  FastSample<T> sample_;
  std::set<KeyHash> written_;  // exclusive topics only
  DataWriter* writer_ = nullptr;
};

}  // namespace limbcast::bus::fastdds
