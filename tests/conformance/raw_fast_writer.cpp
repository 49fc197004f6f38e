#include <cstring>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <utility>

#include "common/bus/fastdds/fast_participant.hpp"
#include "common/bus/fastdds/fast_qos.hpp"
#include "tests/conformance/raw_writer.hpp"

namespace limbcast::conformance {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

// Bytes that claim to be a keyed type; every sample is of one instance.
class BytesType final : public dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 65'000;
    m_isGetKeyDefined = true;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload->max_size) {
      return false;
    }
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* /*payload*/, void* /*data*/) override {
    return false;  // nobody reads with it
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes(); }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* handle, bool /*force_md5*/) override {
    handle->value[7] = 4;
    return true;
  }
};

class RawFastWriter final : public RawWriter {
 public:
  RawFastWriter(std::unique_ptr<bus::fastdds::FastParticipant> participant, dds::DataWriter* writer)
      : participant_(std::move(participant)), writer_(writer) {}
  ~RawFastWriter() override { participant_->publisher().delete_datawriter(writer_); }
  Status Write(const Bytes& payload) override {
    Bytes bytes = payload;
    return writer_->write(&bytes)
               ? Ok()
               : Status(Error{ErrorCode::kUnavailable, "Fast DDS refuses raw bytes"});
  }

 private:
  std::unique_ptr<bus::fastdds::FastParticipant> participant_;
  dds::DataWriter* writer_;
};

}  // namespace

Result<std::unique_ptr<RawWriter>> MakeRawFastWriter(const bus::BusConfig& config,
                                                     const TopicNames& names) {
  auto participant = bus::fastdds::FastParticipant::Make(config, {});
  if (!participant) {
    return participant.error();
  }
  const auto topic =
      (*participant)->TopicOf(names.topic, "raw", dds::TypeSupport(new BytesType(names.type)));
  if (!topic) {
    return topic.error();
  }
  const auto qos = bus::fastdds::WriterQos(names.profile, names.exclusive, config);
  dds::DataWriter* writer = (*participant)->publisher().create_datawriter(*topic, qos);
  if (writer == nullptr) {
    return Error{ErrorCode::kUnavailable, "Fast DDS refuses a raw writer"};
  }
  return std::unique_ptr<RawWriter>(
      std::make_unique<RawFastWriter>(std::move(participant).value(), writer));
}

}  // namespace limbcast::conformance
