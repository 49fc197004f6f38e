#pragma once

#include <cstdint>
#include <string>

#include "common/base/time.hpp"
#include "tools/limbcast/doctor/doctor_facts.hpp"

namespace limbcast::tool {

/// Sends an empty RTPS message to the first discovery ports of `domain` at `peer` (a name or an
/// IPv4 address) and waits at most `patience` for its host to say that nobody listens.
[[nodiscard]] PeerProbe ProbePeer(const std::string& peer, std::uint32_t domain, Duration patience);

}  // namespace limbcast::tool
