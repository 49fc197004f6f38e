#pragma once

#include <cstdint>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus::fastdds {

/// The IPv4 addresses of the interfaces that `config` names (empty = all of them). Fails with
/// kUnavailable naming the interface that this host does not have.
[[nodiscard]] Result<std::vector<std::string>> InterfaceAddresses(const BusConfig& config);

/// How a participant of `config` reaches the others: UDPv4 only (no shared memory), the interfaces
/// and the peers of `config`. `addresses` come from InterfaceAddresses.
[[nodiscard]] Result<eprosima::fastdds::dds::DomainParticipantQos> ParticipantQos(
    const BusConfig& config, const std::vector<std::string>& addresses);

/// Fails with kUnavailable when no participant of `config`'s domain could listen on this host: the
/// library itself would go on without a port, deaf.
[[nodiscard]] Status CheckFreePorts(const BusConfig& config);

/// The lowest participant number that this process does not use, until destroyed. It decides the
/// ports, and peers call only the first 64 of them; the library itself never uses a number twice,
/// so the 65th bus that a process opened could not be found. Thread-safe.
///
/// On a secured network it is not the lowest, but another one for each process and each bus of it,
/// of those whose ports are free (the library would move on to the next, which comes next anyway).
/// A peer on Cyclone DDS keeps a secured participant that has left for its lease, 10 s, and puts
/// what it still has for it into one packet with what it sends to the next one on that port; Fast
/// DDS drops the packet, and when that was the last message of a handshake, it is not repeated.
class ParticipantNumber {
 public:
  explicit ParticipantNumber(const BusConfig& config = {});
  ~ParticipantNumber();
  ParticipantNumber(const ParticipantNumber&) = delete;
  ParticipantNumber& operator=(const ParticipantNumber&) = delete;
  [[nodiscard]] std::int32_t value() const { return value_; }

 private:
  std::int32_t value_ = 0;
};

}  // namespace limbcast::bus::fastdds
