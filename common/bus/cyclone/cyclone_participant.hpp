#pragma once

#include <dds/dds.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"
#include "common/bus/cyclone/cyclone_domain.hpp"
#include "common/bus/cyclone/wire_ops.hpp"
#include "common/bus/endpoint_events.hpp"

namespace limbcast::bus::cyclone {

/// Who hears that bytes of a topic came that do not decode: its readers.
class MalformedListeners {
 public:
  void Add(EndpointEvents* reader);
  void Remove(EndpointEvents* reader);
  void Notify(const char* why);

 private:
  std::mutex mutex_;
  std::vector<EndpointEvents*> readers_;
};

/// A topic of one participant.
struct CycloneTopic {
  dds_entity_t entity = 0;
  const ddsi_sertype* type = nullptr;  ///< lives as long as the topic
  std::shared_ptr<MalformedListeners> malformed;
};

/// One Cyclone DDS participant with one publisher and one subscriber in the partition of the
/// configuration. Thread-safe. Outlives the endpoints made from it.
class CycloneParticipant {
 public:
  /// Fails with kUnavailable or kInvalidArgument, see CycloneDomain::Join.
  [[nodiscard]] static Result<std::unique_ptr<CycloneParticipant>> Make(const BusConfig& config,
                                                                        BusEventHandler on_event);
  ~CycloneParticipant();
  CycloneParticipant(const CycloneParticipant&) = delete;
  CycloneParticipant& operator=(const CycloneParticipant&) = delete;

  /// The topic of that name and type, made at the first call. `short_name` has static storage.
  [[nodiscard]] Result<CycloneTopic> TopicOf(std::string_view name, std::string_view short_name,
                                             const WireOps& ops);

  [[nodiscard]] dds_entity_t publisher() const { return publisher_; }
  [[nodiscard]] dds_entity_t subscriber() const { return subscriber_; }
  [[nodiscard]] const BusConfig& config() const { return config_; }
  [[nodiscard]] const std::shared_ptr<EventSink>& sink() const { return sink_; }
  [[nodiscard]] std::string Describe() const;

 private:
  struct KnownTopic {
    CycloneTopic topic;
    std::string type_name;
    std::string_view short_name;
  };

  CycloneParticipant(const BusConfig& config, std::shared_ptr<CycloneDomain> domain,
                     BusEventHandler on_event);
  [[nodiscard]] Status Open();
  // Remote endpoints, as they are discovered: to name those that use another type.
  [[nodiscard]] Status WatchEndpoints();
  void ReadEndpoints(dds_entity_t reader);
  static void OnEndpoints(dds_entity_t reader, void* self);

  const BusConfig config_;
  const std::shared_ptr<CycloneDomain> domain_;
  const std::shared_ptr<EventSink> sink_;
  dds_entity_t participant_ = 0;
  dds_entity_t publisher_ = 0;
  dds_entity_t subscriber_ = 0;
  std::mutex making_;  // one topic is made at a time; held across calls into the library
  std::mutex names_;   // guards the next two; never held across a call into the library
  std::map<std::string, KnownTopic, std::less<>> known_;
  std::map<std::string, std::string, std::less<>> remote_types_;  // of topics not made yet
};

/// "<what> <topic>: <the library's text>", kTimeout or kUnavailable by the code.
[[nodiscard]] Error CycloneError(std::string_view what, std::string_view topic, dds_return_t code);

}  // namespace limbcast::bus::cyclone
