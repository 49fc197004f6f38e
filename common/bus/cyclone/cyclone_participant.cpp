#include "common/bus/cyclone/cyclone_participant.hpp"

#include <dds/version.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/bus/cyclone/cyclone_log.hpp"
#include "common/bus/cyclone/cyclone_qos.hpp"
#include "common/bus/cyclone/cyclone_security.hpp"
#include "common/bus/cyclone/cyclone_sertype.hpp"
#include "common/bus/network_interfaces.hpp"

namespace limbcast::bus::cyclone {
namespace {

constexpr std::string_view kTopicPrefix = "limbcast/";

}  // namespace

Error CycloneError(std::string_view what, std::string_view topic, dds_return_t code) {
  return Error{code == DDS_RETCODE_TIMEOUT ? ErrorCode::kTimeout : ErrorCode::kUnavailable,
               std::string(what) + " " + std::string(topic) + ": " + dds_strretcode(code)};
}

void MalformedListeners::Add(EndpointEvents* reader) {
  const std::scoped_lock lock(mutex_);
  readers_.push_back(reader);
}

void MalformedListeners::Remove(EndpointEvents* reader) {
  const std::scoped_lock lock(mutex_);
  std::erase(readers_, reader);
}

void MalformedListeners::Notify(const char* why) {
  const std::scoped_lock lock(mutex_);
  for (EndpointEvents* reader : readers_) {
    reader->Malformed(why);
  }
}

CycloneParticipant::CycloneParticipant(const BusConfig& config,
                                       std::shared_ptr<CycloneDomain> domain,
                                       BusEventHandler on_event)
    : config_(config),
      domain_(std::move(domain)),
      sink_(std::make_shared<EventSink>(std::move(on_event))) {}

Result<std::unique_ptr<CycloneParticipant>> CycloneParticipant::Make(const BusConfig& config,
                                                                     BusEventHandler on_event) {
  auto domain = CycloneDomain::Join(config);
  if (!domain) {
    return domain.error();
  }
  std::unique_ptr<CycloneParticipant> participant(
      new CycloneParticipant(config, std::move(domain).value(), std::move(on_event)));
  if (const Status opened = participant->Open(); !opened) {
    return opened.error();
  }
  return participant;
}

CycloneParticipant::~CycloneParticipant() {
  if (participant_ > 0) {
    dds_delete(participant_);  // with all below it
  }
  sink_->Close();
}

Status CycloneParticipant::Open() {
  const std::string where = "domain " + std::to_string(config_.domain_id);
  const Qos qos(dds_create_qos());
  dds_qset_entity_name(qos.get(), config_.participant_name.c_str());
  if (Status secured = AddSecurity(config_, qos.get()); !secured) {
    return secured;
  }
  participant_ = dds_create_participant(config_.domain_id, qos.get(), nullptr);
  if (participant_ < 0) {
    Error refused = CycloneError("participant of", where, participant_);
    if (!config_.security_dir.empty()) {  // its code says only that it was security
      refused.message += ": " + LastCycloneError();
    }
    return refused;
  }
  const Qos group = GroupQos(config_);
  publisher_ = dds_create_publisher(participant_, group.get(), nullptr);
  subscriber_ = dds_create_subscriber(participant_, group.get(), nullptr);
  if (publisher_ < 0 || subscriber_ < 0) {
    return CycloneError("publisher and subscriber of", where, std::min(publisher_, subscriber_));
  }
  return WatchEndpoints();
}

Result<CycloneTopic> CycloneParticipant::TopicOf(std::string_view name, std::string_view short_name,
                                                 const WireOps& ops) {
  const std::scoped_lock making(making_);
  {
    const std::scoped_lock lock(names_);
    if (const auto known = known_.find(name); known != known_.end()) {
      return known->second.topic;
    }
  }
  CycloneTopic topic;
  topic.malformed = std::make_shared<MalformedListeners>();
  ddsi_sertype* type =
      MakeSertype(ops, [malformed = topic.malformed](const char* why) { malformed->Notify(why); });
  topic.entity = dds_create_topic_sertype(participant_, std::string(name).c_str(), &type, nullptr,
                                          nullptr, nullptr);
  if (topic.entity < 0) {
    ddsi_sertype_unref(type);
    return CycloneError("topic", name, topic.entity);
  }
  topic.type = type;
  std::string remote_type;
  {
    const std::scoped_lock lock(names_);
    known_.emplace(name, KnownTopic{topic, ops.type_name, short_name});
    if (const auto remote = remote_types_.find(name); remote != remote_types_.end()) {
      remote_type = remote->second;
    }
  }
  if (!remote_type.empty() && remote_type != ops.type_name) {
    sink_->Emit({.kind = BusEventKind::kTypeMismatch,
                 .topic = short_name,
                 .count = 1,
                 .detail = "ours is " + std::string(ops.type_name) + ", a peer's " + remote_type});
  }
  return topic;
}

Status CycloneParticipant::WatchEndpoints() {
  for (const dds_entity_t builtin :
       {DDS_BUILTIN_TOPIC_DCPSPUBLICATION, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION}) {
    dds_listener_t* listener = dds_create_listener(this);
    dds_lset_data_available(listener, &OnEndpoints);
    const dds_entity_t reader = dds_create_reader(participant_, builtin, nullptr, listener);
    dds_delete_listener(listener);
    if (reader < 0) {
      return CycloneError("discovery reader of", "domain " + std::to_string(config_.domain_id),
                          reader);
    }
    ReadEndpoints(reader);  // what was there before the listener
  }
  return Ok();
}

void CycloneParticipant::OnEndpoints(dds_entity_t reader, void* self) {
  static_cast<CycloneParticipant*>(self)->ReadEndpoints(reader);
}

void CycloneParticipant::ReadEndpoints(dds_entity_t reader) {
  constexpr std::size_t kBatch = 16;
  std::array<void*, kBatch> samples{};
  std::array<dds_sample_info_t, kBatch> infos{};
  dds_return_t count = 0;
  while ((count = dds_take(reader, samples.data(), infos.data(), kBatch, kBatch)) > 0) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const auto* endpoint = static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
      if (!infos[i].valid_data || endpoint->topic_name == nullptr ||
          std::string_view(endpoint->topic_name).substr(0, kTopicPrefix.size()) != kTopicPrefix) {
        continue;
      }
      BusEvent event;
      event.kind = BusEventKind::kTypeMismatch;
      event.count = 1;
      {
        const std::scoped_lock lock(names_);
        const auto known = known_.find(std::string_view(endpoint->topic_name));
        if (known == known_.end()) {
          remote_types_[endpoint->topic_name] = endpoint->type_name;
        } else if (known->second.type_name != endpoint->type_name) {
          event.topic = known->second.short_name;
          event.detail = "ours is " + known->second.type_name + ", a peer's " + endpoint->type_name;
        }
      }
      if (!event.topic.empty()) {
        sink_->Emit(event);
      }
    }
    dds_return_loan(reader, samples.data(), count);
  }
}

std::string CycloneParticipant::Describe() const {
  std::string text = std::string("Cyclone DDS ") + DDS_VERSION + ", domain " +
                     std::to_string(config_.domain_id) + ", partition \"" + config_.partition +
                     "\", " + DescribeNetwork(config_, HostInterfaces());
  if (!config_.security_dir.empty()) {
    text += ", secured as " + config_.security_role;
  }
  return text + (config_.write_batching ? ", batching" : "");
}

}  // namespace limbcast::bus::cyclone
