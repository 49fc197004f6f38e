#include "common/bus/inproc/inproc_bus.hpp"

#include <map>
#include <mutex>
#include <utility>

#include "common/bus/implement_ports.hpp"
#include "common/bus/inproc/channel.hpp"
#include "common/bus/system_now.hpp"

namespace limbcast::bus::inproc {
namespace {

template <typename List>
struct ChannelsOf;
template <typename... Ts>
struct ChannelsOf<std::tuple<Ts...>> {
  using Type = std::tuple<Channel<Ts>...>;
};

}  // namespace

class Hub {
 public:
  explicit Hub(const Clock* clock) : clock_(clock) {}
  template <typename T>
  [[nodiscard]] Channel<T>& channel() {
    return std::get<Channel<T>>(channels_);
  }
  [[nodiscard]] Time Now() const { return clock_ != nullptr ? clock_->Now() : SystemNow(); }

 private:
  const Clock* const clock_;
  ChannelsOf<AllTopics>::Type channels_;
};

namespace {

template <typename T>
class InprocWriter final : public Writer<T> {
 public:
  InprocWriter(std::shared_ptr<Hub> hub, std::shared_ptr<WriterEnd<T>> end)
      : hub_(std::move(hub)), end_(std::move(end)) {
    hub_->channel<T>().AddWriter(end_);
  }
  ~InprocWriter() override { hub_->channel<T>().RemoveWriter(end_); }
  InprocWriter(const InprocWriter&) = delete;
  InprocWriter& operator=(const InprocWriter&) = delete;

  Status Write(const T& value) override {
    if (Status fits = Codec<T>::CheckBounds(value); !fits) {
      return fits;
    }
    end_->events.Sample();
    hub_->channel<T>().Write(*end_, value, hub_->Now());
    return Ok();
  }
  Status Dispose(const T& key) override {
    hub_->channel<T>().Dispose(*end_, key);
    return Ok();
  }
  void Flush() override {}
  [[nodiscard]] EndpointCounters counters() const override { return end_->events.counters(); }

 private:
  const std::shared_ptr<Hub> hub_;
  const std::shared_ptr<WriterEnd<T>> end_;
};

template <typename T>
class InprocReader final : public Reader<T> {
 public:
  InprocReader(std::shared_ptr<Hub> hub, std::shared_ptr<ReaderEnd<T>> end)
      : hub_(std::move(hub)), end_(std::move(end)) {
    hub_->channel<T>().AddReader(end_);
  }
  ~InprocReader() override { hub_->channel<T>().RemoveReader(end_); }
  InprocReader(const InprocReader&) = delete;
  InprocReader& operator=(const InprocReader&) = delete;

  [[nodiscard]] EndpointCounters counters() const override { return end_->events.counters(); }

 private:
  const std::shared_ptr<Hub> hub_;
  const std::shared_ptr<ReaderEnd<T>> end_;
};

class InprocBus final : public ImplementPorts<InprocBus, AllTopics> {
 public:
  InprocBus(std::shared_ptr<Hub> hub, const BusConfig& config, BusEventHandler on_event)
      : hub_(std::move(hub)),
        config_(config),
        sink_(std::make_shared<EventSink>(std::move(on_event))) {}
  ~InprocBus() override { sink_->Close(); }
  InprocBus(const InprocBus&) = delete;
  InprocBus& operator=(const InprocBus&) = delete;

  template <typename T>
  Result<std::unique_ptr<Writer<T>>> MakeTypedWriter() {
    auto end = std::make_shared<WriterEnd<T>>(config_.partition, config_.ownership_strength, sink_);
    return std::unique_ptr<Writer<T>>(std::make_unique<InprocWriter<T>>(hub_, std::move(end)));
  }
  template <typename T>
  Result<std::unique_ptr<Reader<T>>> MakeTypedReader(ReaderHandler<T> handler) {
    auto end = std::make_shared<ReaderEnd<T>>(config_.partition, std::move(handler), sink_);
    return std::unique_ptr<Reader<T>>(std::make_unique<InprocReader<T>>(hub_, std::move(end)));
  }
  [[nodiscard]] std::string Describe() const override {
    return "inproc, domain " + std::to_string(config_.domain_id) + ", partition \"" +
           config_.partition + "\", this process only";
  }

 private:
  const std::shared_ptr<Hub> hub_;
  const BusConfig config_;
  const std::shared_ptr<EventSink> sink_;
};

}  // namespace

std::shared_ptr<Hub> MakeHub(const Clock* clock) { return std::make_shared<Hub>(clock); }

std::shared_ptr<Hub> SharedHub(std::uint32_t domain_id) {
  static std::mutex mutex;
  static std::map<std::uint32_t, std::weak_ptr<Hub>> hubs;
  const std::scoped_lock lock(mutex);
  std::shared_ptr<Hub> hub = hubs[domain_id].lock();
  if (hub == nullptr) {
    hub = MakeHub();
    hubs[domain_id] = hub;
  }
  return hub;
}

std::unique_ptr<Bus> MakeBus(std::shared_ptr<Hub> hub, const BusConfig& config,
                             BusEventHandler on_event) {
  return std::make_unique<InprocBus>(std::move(hub), config, std::move(on_event));
}

}  // namespace limbcast::bus::inproc
