#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"
#include "common/bus/endpoint_events.hpp"
#include "common/bus/events.hpp"
#include "common/bus/fastdds/fast_network.hpp"

namespace limbcast::bus::fastdds {

/// One Fast DDS participant with one publisher and one subscriber in the partition of the
/// configuration. Thread-safe. Outlives the endpoints made from it.
class FastParticipant final : private eprosima::fastdds::dds::DomainParticipantListener {
 public:
  /// Fails with kInvalidArgument (a peer) or kUnavailable (interface or ports not there).
  [[nodiscard]] static Result<std::unique_ptr<FastParticipant>> Make(const BusConfig& config,
                                                                     BusEventHandler on_event);
  ~FastParticipant() override;
  FastParticipant(const FastParticipant&) = delete;
  FastParticipant& operator=(const FastParticipant&) = delete;

  /// The topic of that name and type, made at the first call. `short_name` has static storage.
  [[nodiscard]] Result<eprosima::fastdds::dds::Topic*> TopicOf(
      std::string_view name, std::string_view short_name,
      const eprosima::fastdds::dds::TypeSupport& type);

  [[nodiscard]] eprosima::fastdds::dds::Publisher& publisher() { return *publisher_; }
  [[nodiscard]] eprosima::fastdds::dds::Subscriber& subscriber() { return *subscriber_; }
  [[nodiscard]] const BusConfig& config() const { return config_; }
  [[nodiscard]] const std::shared_ptr<EventSink>& sink() const { return sink_; }
  [[nodiscard]] std::string Describe() const;

 private:
  struct KnownTopic {
    std::string type_name;
    std::string_view short_name;
  };

  FastParticipant(const BusConfig& config, BusEventHandler on_event)
      : config_(config), sink_(std::make_shared<EventSink>(std::move(on_event))), number_(config) {}
  [[nodiscard]] Status Open();

  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;
  // Two endpoints match when topic and type names agree, else the library says nothing at all.
  void CompareTypes(const std::string& topic, const std::string& remote_type);
  void RaiseTypeMismatch(std::string_view short_name, const std::string& ours,
                         const std::string& theirs);

  BusConfig config_;
  std::shared_ptr<EventSink> sink_;
  const ParticipantNumber number_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  std::mutex making_;  // one topic is made at a time; held across calls into the library
  std::mutex names_;   // guards the next two; never held across a call into the library
  std::map<std::string, KnownTopic, std::less<>> known_;
  std::map<std::string, std::string, std::less<>> remote_types_;  // of topics of the project
};

}  // namespace limbcast::bus::fastdds
