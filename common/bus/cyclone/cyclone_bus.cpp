#include "common/bus/cyclone/cyclone_bus.hpp"

#include <utility>

#include "common/bus/cyclone/cyclone_endpoints.hpp"
#include "common/bus/cyclone/cyclone_participant.hpp"
#include "common/bus/implement_ports.hpp"

namespace limbcast::bus::cyclone {
namespace {

class CycloneBus final : public ImplementPorts<CycloneBus, AllTopics> {
 public:
  explicit CycloneBus(std::unique_ptr<CycloneParticipant> participant)
      : participant_(std::move(participant)) {}

  template <typename T>
  Result<std::unique_ptr<Writer<T>>> MakeTypedWriter() {
    return MakeCycloneWriter<T>(*participant_);
  }
  template <typename T>
  Result<std::unique_ptr<Reader<T>>> MakeTypedReader(ReaderHandler<T> handler) {
    return MakeCycloneReader<T>(*participant_, std::move(handler));
  }
  [[nodiscard]] std::string Describe() const override { return participant_->Describe(); }

 private:
  const std::unique_ptr<CycloneParticipant> participant_;
};

}  // namespace

Result<std::unique_ptr<Bus>> OpenCyclone(const BusConfig& config, BusEventHandler on_event) {
  auto participant = CycloneParticipant::Make(config, std::move(on_event));
  if (!participant) {
    return participant.error();
  }
  return std::unique_ptr<Bus>(std::make_unique<CycloneBus>(std::move(participant).value()));
}

}  // namespace limbcast::bus::cyclone
