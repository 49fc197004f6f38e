#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace limbcast::tool {

/// How many participant numbers of `domain` have their discovery port among `used_ports`: 7400 +
/// 250 domain + 10 + 2 number (DDSI-RTPS 2.2, 9.6.1.1).
[[nodiscard]] std::size_t CountParticipants(const std::vector<std::uint16_t>& used_ports,
                                            std::uint32_t domain);
/// The same for this host now.
[[nodiscard]] std::size_t CountParticipants(std::uint32_t domain);

/// Files of Fast DDS in `shared_memory` (/dev/shm) that no process of `processes` (/proc) has open
/// or mapped. Sees only what this user may see of other processes.
[[nodiscard]] std::vector<std::string> StaleSharedMemory(
    const std::filesystem::path& shared_memory = "/dev/shm",
    const std::filesystem::path& processes = "/proc");

/// The number in a file like /proc/sys/net/core/rmem_max; 0 when there is none.
[[nodiscard]] std::int64_t NumberIn(const std::filesystem::path& file);

}  // namespace limbcast::tool
