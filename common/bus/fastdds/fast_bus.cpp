#include "common/bus/fastdds/fast_bus.hpp"

#include <utility>

#include "common/bus/fastdds/fast_endpoints.hpp"
#include "common/bus/fastdds/fast_participant.hpp"
#include "common/bus/implement_ports.hpp"

namespace limbcast::bus::fastdds {
namespace {

class FastBus final : public ImplementPorts<FastBus, AllTopics> {
 public:
  explicit FastBus(std::unique_ptr<FastParticipant> participant)
      : participant_(std::move(participant)) {}
  [[nodiscard]] std::string Describe() const override { return participant_->Describe(); }

  template <typename T>
  Result<std::unique_ptr<Writer<T>>> MakeTypedWriter() {
    return MakeFastWriter<T>(*participant_);
  }
  template <typename T>
  Result<std::unique_ptr<Reader<T>>> MakeTypedReader(ReaderHandler<T> handler) {
    return MakeFastReader<T>(*participant_, std::move(handler));
  }

 private:
  std::unique_ptr<FastParticipant> participant_;
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
