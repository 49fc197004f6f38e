#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"

namespace limbcast::bus::cyclone {

/// The library's configuration of the domain of `config`: network, discovery, batching. Pure.
[[nodiscard]] std::string DomainXml(const BusConfig& config);

/// A DDS domain as this process has joined it. The library has one configuration for each domain
/// and process, so all buses of a domain share one of these; the last one leaves the domain.
class CycloneDomain {
 public:
  /// Fails with kUnavailable (no such interface, no free participant index) or kInvalidArgument
  /// (this process is in the domain already, with another network or batching).
  [[nodiscard]] static Result<std::shared_ptr<CycloneDomain>> Join(const BusConfig& config);
  ~CycloneDomain();
  CycloneDomain(const CycloneDomain&) = delete;
  CycloneDomain& operator=(const CycloneDomain&) = delete;

 private:
  CycloneDomain(std::int32_t entity, std::string xml) : entity_(entity), xml_(std::move(xml)) {}
  const std::int32_t entity_;
  const std::string xml_;
};

}  // namespace limbcast::bus::cyclone
