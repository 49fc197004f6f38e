#include "common/bus/fastdds/fast_bus.hpp"

#include <tuple>
#include <utility>

#include "common/bus/fastdds/fast_endpoints.hpp"
#include "common/bus/fastdds/fast_participant.hpp"

namespace limbcast::bus::fastdds {
namespace {

// The ports of a type list, one class for each type on top of the next.
template <typename List>
class FastPorts;

template <>
class FastPorts<std::tuple<>> : public Bus {
 public:
  explicit FastPorts(std::unique_ptr<FastParticipant> participant)
      : participant_(std::move(participant)) {}

 protected:
  using Bus::DoMakeReader;
  using Bus::DoMakeWriter;
  std::unique_ptr<FastParticipant> participant_;
};

template <typename T, typename... Rest>
class FastPorts<std::tuple<T, Rest...>> : public FastPorts<std::tuple<Rest...>> {
 public:
  using FastPorts<std::tuple<Rest...>>::FastPorts;

 protected:
  using FastPorts<std::tuple<Rest...>>::DoMakeReader;
  using FastPorts<std::tuple<Rest...>>::DoMakeWriter;
  Result<std::unique_ptr<Writer<T>>> DoMakeWriter(TypeTag<T> /*tag*/) override {
    return MakeFastWriter<T>(*this->participant_);
  }
  Result<std::unique_ptr<Reader<T>>> DoMakeReader(TypeTag<T> /*tag*/,
                                                  ReaderHandler<T> handler) override {
    return MakeFastReader<T>(*this->participant_, std::move(handler));
  }
};

class FastBus final : public FastPorts<AllTopics> {
 public:
  using FastPorts<AllTopics>::FastPorts;
  [[nodiscard]] std::string Describe() const override { return participant_->Describe(); }
};

}  // namespace

Result<std::unique_ptr<Bus>> OpenFast(const BusConfig& config, BusEventHandler on_event) {
  auto participant = FastParticipant::Make(config, std::move(on_event));
  if (!participant) {
    return participant.error();
  }
  return std::unique_ptr<Bus>(std::make_unique<FastBus>(std::move(participant).value()));
}

}  // namespace limbcast::bus::fastdds
