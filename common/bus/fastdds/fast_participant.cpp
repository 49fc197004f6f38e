#include "common/bus/fastdds/fast_participant.hpp"

#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/config.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <utility>
#include <vector>

#include "common/bus/fastdds/fast_log.hpp"
#include "common/bus/fastdds/fast_network.hpp"
#include "common/bus/fastdds/fast_security.hpp"
#include "common/bus/network_interfaces.hpp"

namespace limbcast::bus::fastdds {
namespace {

namespace dds = eprosima::fastdds::dds;

constexpr std::string_view kTopicPrefix = "limbcast/";

// Settings of the whole process, before its first participant.
void PrepareLibrary() {
  QuietFastLog();
  // One way of delivery: also within a process samples take the network path, on the receiving
  // thread. The shortcut would run handlers on the writing thread, inside the library's locks.
  static std::once_flag once;
  std::call_once(once, [] {
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  });
}

Error Refused(const std::string& what, const BusConfig& config) {
  const std::string reason = LastFastError();
  return Error{ErrorCode::kUnavailable, "Fast DDS refuses " + what + " in domain " +
                                            std::to_string(config.domain_id) +
                                            (reason.empty() ? "" : ": " + reason)};
}

}  // namespace

Result<std::unique_ptr<FastParticipant>> FastParticipant::Make(const BusConfig& config,
                                                               BusEventHandler on_event) {
  std::unique_ptr<FastParticipant> made(new FastParticipant(config, std::move(on_event)));
  if (Status opened = made->Open(); !opened) {
    return opened.error();
  }
  return made;
}

Status FastParticipant::Open() {
  PrepareLibrary();
  const auto addresses = InterfaceAddresses(config_);
  if (!addresses) {
    return addresses.error();
  }
  auto qos = ParticipantQos(config_, *addresses);
  if (!qos) {
    return qos.error();
  }
  if (Status ports = CheckFreePorts(config_); !ports) {
    return ports;
  }
  if (Status secured = AddSecurity(config_, *qos); !secured) {
    return secured;
  }
  qos->wire_protocol().participant_id = number_.value();
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
      config_.domain_id, *qos, this, dds::StatusMask::none());
  if (participant_ == nullptr) {
    return Refused("a participant", config_);
  }
  dds::PublisherQos publisher_qos;
  dds::SubscriberQos subscriber_qos;
  if (!config_.partition.empty()) {
    publisher_qos.partition().push_back(config_.partition.c_str());
    subscriber_qos.partition().push_back(config_.partition.c_str());
  }
  publisher_ = participant_->create_publisher(publisher_qos);
  subscriber_ = participant_->create_subscriber(subscriber_qos);
  if (publisher_ == nullptr || subscriber_ == nullptr) {
    return Refused("a publisher or subscriber", config_);
  }
  return Ok();
}

FastParticipant::~FastParticipant() {
  sink_->Close();
  if (participant_ != nullptr) {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
}

Result<dds::Topic*> FastParticipant::TopicOf(std::string_view name, std::string_view short_name,
                                             const dds::TypeSupport& type) {
  const std::string topic_name(name);
  const std::lock_guard making(making_);
  if (auto* made = dynamic_cast<dds::Topic*>(participant_->lookup_topicdescription(topic_name))) {
    return made;
  }
  if (participant_->register_type(type) != eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    return Refused("type " + type.get_type_name(), config_);
  }
  dds::Topic* topic = participant_->create_topic(topic_name, type.get_type_name(), dds::TopicQos());
  if (topic == nullptr) {
    return Refused("topic " + topic_name, config_);
  }
  std::string remote_type;
  {
    const std::lock_guard lock(names_);
    known_.emplace(topic_name, KnownTopic{type.get_type_name(), short_name});
    if (const auto it = remote_types_.find(topic_name); it != remote_types_.end()) {
      remote_type = it->second;
    }
  }
  if (!remote_type.empty() && remote_type != type.get_type_name()) {
    RaiseTypeMismatch(short_name, type.get_type_name(), remote_type);
  }
  return topic;
}

void FastParticipant::on_publisher_discovery(dds::DomainParticipant* /*participant*/,
                                             eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) {
  if (info.status == eprosima::fastrtps::rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) {
    CompareTypes(info.info.topicName().to_string(), info.info.typeName().to_string());
  }
}

void FastParticipant::on_subscriber_discovery(
    dds::DomainParticipant* /*participant*/, eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) {
  if (info.status == eprosima::fastrtps::rtps::ReaderDiscoveryInfo::DISCOVERED_READER) {
    CompareTypes(info.info.topicName().to_string(), info.info.typeName().to_string());
  }
}

void FastParticipant::CompareTypes(const std::string& topic, const std::string& remote_type) {
  if (!topic.starts_with(kTopicPrefix)) {
    return;
  }
  KnownTopic known;
  {
    const std::lock_guard lock(names_);
    remote_types_[topic] = remote_type;
    const auto it = known_.find(topic);
    if (it == known_.end() || it->second.type_name == remote_type) {
      return;
    }
    known = it->second;
  }
  RaiseTypeMismatch(known.short_name, known.type_name, remote_type);
}

void FastParticipant::RaiseTypeMismatch(std::string_view short_name, const std::string& ours,
                                        const std::string& theirs) {
  sink_->Emit({.kind = BusEventKind::kTypeMismatch,
               .topic = short_name,
               .count = 1,
               .detail = "ours is " + ours + ", a peer's " + theirs});
}

std::string FastParticipant::Describe() const {
  std::string text = "Fast DDS " + std::to_string(FASTRTPS_VERSION_MAJOR) + "." +
                     std::to_string(FASTRTPS_VERSION_MINOR) + "." +
                     std::to_string(FASTRTPS_VERSION_MICRO) + ", domain " +
                     std::to_string(config_.domain_id) + ", partition \"" + config_.partition +
                     "\", " + DescribeNetwork(config_, HostInterfaces());
  if (!config_.security_dir.empty()) {
    text += ", secured as " + config_.security_role;
  }
  return text;
}

}  // namespace limbcast::bus::fastdds
