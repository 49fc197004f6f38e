#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "common/bus/cyclone/cyclone_participant.hpp"
#include "common/bus/cyclone/cyclone_qos.hpp"
#include "common/bus/cyclone/wire_ops.hpp"
#include "tests/conformance/raw_writer.hpp"

namespace limbcast::conformance {
namespace {

using bus::KeyHash;

// Bytes that claim to be a keyed type; every sample is of one instance.
KeyHash OneKey() {
  KeyHash key{};
  key[7] = 4;
  return key;
}

std::size_t WriteKey(std::span<char> out) {
  const KeyHash key = OneKey();
  out[0] = 0;
  out[1] = 0;  // big-endian
  out[2] = 0;
  out[3] = 0;
  std::memcpy(out.data() + 4, key.data(), 8);
  return 12;
}

bus::cyclone::WireOps BytesOps(const char* type_name) {
  return {
      .type_name = type_name,
      .serialized_size = [](const void* wire) { return static_cast<const Bytes*>(wire)->size(); },
      .serialize =
          [](const void* wire, std::span<char> out) {
            const auto& bytes = *static_cast<const Bytes*>(wire);
            const std::size_t used = std::min(bytes.size(), out.size());
            std::memcpy(out.data(), bytes.data(), used);
            return used;
          },
      .deserialize = [](std::span<const char>, void*) { return false; },  // nobody reads with it
      .serialize_key = [](const void*, std::span<char> out) { return WriteKey(out); },
      .hash_key = [](const void*) { return OneKey(); },
      .read_key =
          [](std::span<const char>, bool, KeyHash& key) {
            key = OneKey();
            return true;
          },
      .serialize_key_hash = [](const KeyHash&, std::span<char> out) { return WriteKey(out); },
  };
}

class RawCycloneWriter final : public RawWriter {
 public:
  // The type keeps a pointer to `ops`, and `ops` one to the name, so both stay where they are.
  explicit RawCycloneWriter(const TopicNames& names)
      : type_name_(names.type), ops_(BytesOps(type_name_.c_str())) {}
  ~RawCycloneWriter() override {
    if (writer_ > 0) {
      dds_delete(writer_);
    }
  }

  Status Open(const bus::BusConfig& config, const TopicNames& names) {
    auto participant = bus::cyclone::CycloneParticipant::Make(config, {});
    if (!participant) {
      return participant.error();
    }
    participant_ = std::move(participant).value();
    const auto topic = participant_->TopicOf(names.topic, "raw", ops_);
    if (!topic) {
      return topic.error();
    }
    const auto qos = bus::cyclone::WriterQos(names.profile, names.exclusive, config);
    writer_ = dds_create_writer(participant_->publisher(), topic->entity, qos.get(), nullptr);
    return writer_ < 0 ? Status(bus::cyclone::CycloneError("raw writer of", names.topic, writer_))
                       : Ok();
  }

  Status Write(const Bytes& payload) override {
    const dds_return_t code = dds_write(writer_, &payload);
    return code < 0 ? Status(bus::cyclone::CycloneError("raw write", type_name_, code)) : Ok();
  }

 private:
  const std::string type_name_;
  const bus::cyclone::WireOps ops_;
  std::unique_ptr<bus::cyclone::CycloneParticipant> participant_;
  dds_entity_t writer_ = 0;
};

}  // namespace

Result<std::unique_ptr<RawWriter>> MakeRawCycloneWriter(const bus::BusConfig& config,
                                                        const TopicNames& names) {
  auto writer = std::make_unique<RawCycloneWriter>(names);
  if (Status opened = writer->Open(config, names); !opened) {
    return opened.error();
  }
  return std::unique_ptr<RawWriter>(std::move(writer));
}

}  // namespace limbcast::conformance
