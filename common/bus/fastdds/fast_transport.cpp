#include "common/bus/fastdds/fast_transport.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>

#include <utility>

#include "common/bus/wire/rtps_fragments.hpp"

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastdds::rtps::ChainingTransport;
using eprosima::fastdds::rtps::ChainingTransportDescriptor;
using eprosima::fastdds::rtps::TransportInterface;
using eprosima::fastdds::rtps::TransportReceiverInterface;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::LocatorsIterator;
using eprosima::fastrtps::rtps::octet;
using eprosima::fastrtps::rtps::SenderResource;

struct KeylessFragmentsDescriptor : ChainingTransportDescriptor {
  using ChainingTransportDescriptor::ChainingTransportDescriptor;
  [[nodiscard]] TransportInterface* create_transport() const override;
};

class KeylessFragments : public ChainingTransport {
 public:
  explicit KeylessFragments(const KeylessFragmentsDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  KeylessFragmentsDescriptor* get_configuration() override { return &descriptor_; }

  bool send(SenderResource* low_sender_resource, const octet* send_buffer,
            uint32_t send_buffer_size, LocatorsIterator* destination_locators_begin,
            LocatorsIterator* destination_locators_end,
            const std::chrono::steady_clock::time_point& timeout) override {
    return low_sender_resource->send(send_buffer, send_buffer_size, destination_locators_begin,
                                     destination_locators_end, timeout);
  }

  void receive(TransportReceiverInterface* next_receiver, const octet* receive_buffer,
               uint32_t receive_buffer_size, const Locator_t& local_locator,
               const Locator_t& remote_locator) override {
    // NOLINTNEXTLINE(*-const-cast): the channel's own buffer; ChainingTransport.h lets us write it
    if (ForgetKeysOfFragments({const_cast<octet*>(receive_buffer), receive_buffer_size})) {
      next_receiver->OnDataReceived(receive_buffer, receive_buffer_size, local_locator,
                                    remote_locator);
    }
  }

 private:
  KeylessFragmentsDescriptor descriptor_;
};

TransportInterface* KeylessFragmentsDescriptor::create_transport() const {
  return new KeylessFragments(*this);  // NOLINT(*-owning-memory): the interface of Fast DDS
}

}  // namespace

std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> WithoutKeysOfFragments(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport) {
  return std::make_shared<KeylessFragmentsDescriptor>(std::move(transport));
}

}  // namespace limbcast::bus::fastdds
