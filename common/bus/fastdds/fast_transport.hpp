#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <memory>

namespace limbcast::bus::fastdds {

/// `transport`, whose fragments come in without their key hash. With one, Fast DDS 2.9 files a
/// sample under its instance at the first fragment; when the writer then says that the rest is gone
/// (GAP), it frees the sample and leaves it filed there (StatefulReader.cpp:874), and the reader
/// ends its process or uses what is freed. Cyclone DDS sends key hashes to Fast DDS. On a secured
/// network messages are still encrypted here, and nothing is changed.
[[nodiscard]] std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
WithoutKeysOfFragments(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport);

}  // namespace limbcast::bus::fastdds
