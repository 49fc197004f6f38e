#pragma once

#include <string_view>

namespace limbcast::bus::inproc {

/// Whether endpoints in these two partitions hear each other, as DDS 1.4 section 2.2.3.13 says:
/// equal names, or one is a pattern ('*' any characters, '?' one) that matches the other's name.
/// Two patterns match only when equal. "" is the default partition.
[[nodiscard]] bool PartitionsMatch(std::string_view a, std::string_view b);

}  // namespace limbcast::bus::inproc
