#pragma once

#include <dds/dds.h>

#include <mutex>
#include <set>
#include <string>

#include "common/bus/cyclone/cyclone_listener.hpp"
#include "common/bus/cyclone/cyclone_participant.hpp"
#include "common/bus/cyclone/cyclone_qos.hpp"
#include "common/bus/cyclone/cyclone_sertype.hpp"
#include "common/bus/cyclone/wire_ops.hpp"
#include "common/bus/endpoint_events.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/wire/codec.hpp"
#include "common/bus/writer.hpp"

namespace limbcast::bus::cyclone {

/// Writes T through one Cyclone DDS writer. Thread-safe.
template <typename T>
class CycloneWriter final : public Writer<T> {
 public:
  explicit CycloneWriter(CycloneParticipant& participant)
      : participant_(participant), events_(Topic<T>::kShortName, true, participant.sink()) {}
  ~CycloneWriter() override {
    if (writer_ > 0) {
      UnregisterAll();
      dds_delete(writer_);
    }
  }
  CycloneWriter(const CycloneWriter&) = delete;
  CycloneWriter& operator=(const CycloneWriter&) = delete;

  [[nodiscard]] Status Open() {
    const auto topic = participant_.TopicOf(Topic<T>::kName, Topic<T>::kShortName, WireOpsOf<T>());
    if (!topic) {
      return topic.error();
    }
    type_ = topic->type;
    const Qos qos =
        WriterQos(Topic<T>::kProfile, Topic<T>::kExclusiveOwnership, participant_.config());
    const Listener listener = WriterListener(events_);
    writer_ = dds_create_writer(participant_.publisher(), topic->entity, qos.get(), listener.get());
    return writer_ < 0 ? CycloneError("writer of", Topic<T>::kName, writer_) : Status();
  }

  [[nodiscard]] Status Write(const T& value) override {
    const std::scoped_lock lock(mutex_);
    if (Status encoded = Codec<T>::Encode(value, wire_); !encoded) {
      return encoded;
    }
    if (const dds_return_t code = dds_write(writer_, &wire_); code != DDS_RETCODE_OK) {
      return CycloneError("write", Topic<T>::kName, code);
    }
    if constexpr (Topic<T>::kExclusiveOwnership) {
      written_.insert(Codec<T>::HashKey(wire_));
    }
    events_.Sample();
    return Ok();
  }

  [[nodiscard]] Status Dispose(const T& key) override {
    const std::scoped_lock lock(mutex_);
    Codec<T>::EncodeKey(key, wire_);
    // In one message: of two, a reader may miss the first, and then keeps the instance. Disposing
    // alone ends processes that read with Fast DDS, see FastWriter.
    const dds_return_t code = dds_forwardcdr(writer_, MakeDisposal(type_, &wire_));
    written_.erase(Codec<T>::HashKey(wire_));
    Flush();  // rare, and not to wait for the next burst
    return code == DDS_RETCODE_OK ? Status() : CycloneError("dispose", Topic<T>::kName, code);
  }

  void Flush() override {
    if (participant_.config().write_batching) {
      dds_write_flush(writer_);
    }
  }

  [[nodiscard]] EndpointCounters counters() const override { return events_.counters(); }

 private:
  // A weaker writer takes over at once when the owner says good-bye to its instances.
  void UnregisterAll() {
    for (const KeyHash& key : written_) {
      Codec<T>::FromKeyHash(key, wire_);
      dds_unregister_instance(writer_, &wire_);
    }
    Flush();
  }

  CycloneParticipant& participant_;
  EndpointEvents events_;
  std::mutex mutex_;  // guards the next two and keeps samples in the order of the calls
  typename Codec<T>::Wire wire_;
  std::set<KeyHash> written_;  // exclusive topics only
  const ddsi_sertype* type_ = nullptr;
  dds_entity_t writer_ = 0;
};

}  // namespace limbcast::bus::cyclone
