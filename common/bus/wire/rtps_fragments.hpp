#pragma once

#include <cstdint>
#include <span>

namespace limbcast::bus {

/// Renames the key hash beside each fragment of a sample (DATA_FRAG, DDSI-RTPS 2.2, 9.4.5.4) in one
/// RTPS message to padding, in place, so that the key is known when the sample is whole and its
/// bytes say it. Takes any bytes. False: a fragment's parameters run past its end, and who does not
/// mind that end could read another key there; such a message must go no further. Does not
/// allocate.
[[nodiscard]] bool ForgetKeysOfFragments(std::span<std::uint8_t> message);

}  // namespace limbcast::bus
