#pragma once

#include <dds/dds.h>

#include <array>
#include <memory>
#include <string>
#include <unordered_set>
#include <utility>

#include "common/bus/cyclone/cyclone_listener.hpp"
#include "common/bus/cyclone/cyclone_participant.hpp"
#include "common/bus/cyclone/cyclone_qos.hpp"
#include "common/bus/cyclone/cyclone_sertype.hpp"
#include "common/bus/cyclone/wire_ops.hpp"
#include "common/bus/endpoint_events.hpp"
#include "common/bus/reader.hpp"
#include "common/bus/system_now.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/wire/codec.hpp"

namespace limbcast::bus::cyclone {

/// Reads T through one Cyclone DDS reader and calls the handler on the library's receiving thread.
/// The bytes are decoded once, into objects that are reused.
template <typename T>
class CycloneReader final : public Reader<T> {
 public:
  CycloneReader(CycloneParticipant& participant, ReaderHandler<T> handler)
      : participant_(participant),
        events_(Topic<T>::kShortName, false, participant.sink()),
        handler_(std::move(handler)) {}
  ~CycloneReader() override {
    if (reader_ > 0) {
      dds_delete(reader_);  // waits for a listener that runs
    }
    if (malformed_ != nullptr) {
      malformed_->Remove(&events_);
    }
  }
  CycloneReader(const CycloneReader&) = delete;
  CycloneReader& operator=(const CycloneReader&) = delete;

  [[nodiscard]] Status Open() {
    const auto topic = participant_.TopicOf(Topic<T>::kName, Topic<T>::kShortName, WireOpsOf<T>());
    if (!topic) {
      return topic.error();
    }
    malformed_ = topic->malformed;
    malformed_->Add(&events_);
    const Qos qos =
        ReaderQos(Topic<T>::kProfile, Topic<T>::kExclusiveOwnership, participant_.config());
    const Listener listener = ReaderListener(events_, Topic<T>::kExclusiveOwnership, &OnData, this);
    reader_ =
        dds_create_reader(participant_.subscriber(), topic->entity, qos.get(), listener.get());
    return reader_ < 0 ? CycloneError("reader of", Topic<T>::kName, reader_) : Status();
  }

  [[nodiscard]] EndpointCounters counters() const override { return events_.counters(); }

 private:
  static constexpr std::size_t kBatch = 32;

  static void OnData(dds_entity_t reader, void* self) {
    static_cast<CycloneReader*>(self)->TakeAll(reader);
  }

  // The library runs one listener of an entity at a time, so this needs no lock.
  void TakeAll(dds_entity_t reader) {
    dds_return_t count = 0;
    while ((count = dds_takecdr(
                reader, samples_.data(), kBatch, infos_.data(),
                DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE)) > 0) {
      const SampleInfo info{.received_at = SystemNow()};
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        if (infos_[i].valid_data) {
          Deliver(Payload(samples_[i]), info);
        } else if (infos_[i].instance_state == DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE) {
          DeliverDisposed(Payload(samples_[i]));
        }
        ddsi_serdata_unref(samples_[i]);
      }
    }
  }

  void Deliver(std::span<const char> bytes, const SampleInfo& info) {
    if (!Codec<T>::Deserialize(bytes, wire_)) {
      events_.Malformed("bytes that are no " + std::string(Codec<T>::kTypeName));
      return;
    }
    if (const Status decoded = Codec<T>::Decode(wire_, value_); !decoded) {
      events_.Malformed(decoded.error().message);
      return;
    }
    known_.insert(Codec<T>::Key(value_));
    events_.Sample();
    if (handler_.on_sample) {
      handler_.on_sample(value_, info);
    }
  }

  void DeliverDisposed(std::span<const char> bytes) {
    if (!Codec<T>::DeserializeKey(bytes, wire_) || !Codec<T>::DecodeKey(wire_, value_)) {
      events_.Malformed("dispose with a key that is none");
      return;
    }
    if (known_.erase(Codec<T>::Key(value_)) == 0) {
      return;  // what was never heard of is nobody's business
    }
    events_.Disposed();
    if (handler_.on_disposed) {
      handler_.on_disposed(value_);
    }
  }

  CycloneParticipant& participant_;
  EndpointEvents events_;
  const ReaderHandler<T> handler_;
  std::shared_ptr<MalformedListeners> malformed_;
  std::array<ddsi_serdata*, kBatch> samples_{};
  std::array<dds_sample_info_t, kBatch> infos_{};
  typename Codec<T>::Wire wire_;
  T value_;
  std::unordered_set<InstanceKey> known_;  // instances heard of and not disposed
  dds_entity_t reader_ = 0;
};

}  // namespace limbcast::bus::cyclone
