#include "tests/system/security/secure_session.hpp"

#include <atomic>
#include <mutex>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "common/bus/bus_factory.hpp"
#include "tests/support/topic_examples.hpp"

namespace limbcast::security_test {
namespace {

// Keys that came, from all readers of a bus.
class HeardKeys {
 public:
  void Add(std::uint32_t key) {
    const std::scoped_lock lock(mutex_);
    keys_.insert(key);
  }
  [[nodiscard]] std::string Text() const {
    const std::scoped_lock lock(mutex_);
    std::string text;
    for (const std::uint32_t key : keys_) {
      text += std::to_string(key) + ' ';
    }
    return text;
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::uint32_t> keys_;
};

template <typename T>
struct Pair {
  std::atomic<std::uint64_t> of_others{0};
  std::string writer_refusal;
  std::string reader_refusal;
  std::unique_ptr<bus::Writer<T>> writer;
  std::unique_ptr<bus::Reader<T>> reader;  // destroyed first: its handler counts above

  static std::string Name() { return std::string(bus::Topic<T>::kShortName); }

  void Make(bus::Bus& bus, std::uint32_t own_key, HeardKeys& keys) {
    if (auto made = bus.MakeWriter<T>(); made) {
      writer = std::move(*made);
    } else {
      writer_refusal = made.error().message;
    }
    auto made = bus.MakeReader<T>({.on_sample =
                                       [this, own_key, &keys](const T& value, const auto&) {
                                         const auto key = test_support::ExampleKey(value);
                                         keys.Add(key);
                                         of_others += key == own_key ? 0U : 1U;
                                       },
                                   .on_disposed = {}});
    if (made) {
      reader = std::move(*made);
    } else {
      reader_refusal = made.error().message;
    }
  }
  void Write(std::uint32_t key, std::uint32_t sequence) {
    if (writer != nullptr) {
      (void)writer->Write(test_support::Example<T>(key, sequence));
      writer->Flush();
    }
  }
  [[nodiscard]] std::string Made() const {
    return (writer ? "+w:" : "-w:") + Name() + (reader ? " +r:" : " -r:") + Name() + ' ';
  }
  [[nodiscard]] std::string Counts() const {
    return Name() + '=' + std::to_string(writer ? writer->counters().matched : 0) + '/' +
           std::to_string(reader ? reader->counters().matched : 0) + '/' +
           std::to_string(of_others) + ' ';
  }
  void Why(const std::string& endpoint, std::string& why) const {
    if (endpoint == "w:" + Name()) {
      why = writer_refusal;
    } else if (endpoint == "r:" + Name()) {
      why = reader_refusal;
    }
  }
};

template <typename... Ts>
class Endpoints final : public AllEndpoints {
 public:
  Endpoints(bus::Bus& bus, std::uint32_t own_key) {
    (std::get<Pair<Ts>>(pairs_).Make(bus, own_key, keys_), ...);
  }
  [[nodiscard]] std::string Made() const override {
    return (std::get<Pair<Ts>>(pairs_).Made() + ...);
  }
  [[nodiscard]] std::string Why(const std::string& endpoint) const override {
    std::string why;
    (std::get<Pair<Ts>>(pairs_).Why(endpoint, why), ...);
    return why;
  }
  void Write(std::uint32_t key, std::uint32_t sequence) override {
    (std::get<Pair<Ts>>(pairs_).Write(key, sequence), ...);
  }
  [[nodiscard]] std::string Counts() const override {
    return (std::get<Pair<Ts>>(pairs_).Counts() + ...);
  }
  [[nodiscard]] std::string Keys() const override { return keys_.Text(); }

 private:
  HeardKeys keys_;
  std::tuple<Pair<Ts>...> pairs_;
};

template <typename... Ts>
std::unique_ptr<AllEndpoints> Make(bus::Bus& bus, std::uint32_t own_key,
                                   bus::TypeTag<std::tuple<Ts...>> /*list*/) {
  return std::make_unique<Endpoints<Ts...>>(bus, own_key);
}

}  // namespace

std::unique_ptr<AllEndpoints> MakeAllEndpoints(bus::Bus& bus, std::uint32_t own_key) {
  return Make(bus, own_key, bus::TypeTag<bus::AllTopics>{});
}

std::string SecureSession::Do(const std::string& line) {
  std::istringstream words(line);
  const Result<std::string> reply = Dispatch(words);
  return reply ? "ok " + *reply : "error " + reply.error().message;
}

Result<std::string> SecureSession::OpenBus(const std::string& name, std::istringstream& words) {
  std::string vendor;
  std::string folder;
  bus::BusConfig config;
  Open open;
  words >> vendor >> config.domain_id >> folder >> config.security_role >> open.key;
  config.vendor = bus::ParseVendor(vendor).value();
  config.security_dir = folder == "-" ? "" : folder;
  config.participant_name = "limbcast-secure-peer";
  auto opened = bus::Open(config);
  if (!opened) {
    return opened.error();
  }
  open.bus = std::move(*opened);
  std::string description = open.bus->Describe();
  buses_.insert_or_assign(name, std::move(open));
  return description;
}

Result<std::string> SecureSession::Dispatch(std::istringstream& words) {
  std::string verb;
  std::string name;
  words >> verb >> name;
  if (verb == "open") {
    return OpenBus(name, words);
  }
  const auto found = buses_.find(name);
  if (found == buses_.end()) {
    return Error{ErrorCode::kNotFound, "no bus " + name};
  }
  Open& open = found->second;
  if (verb == "endpoints") {
    open.endpoints = MakeAllEndpoints(*open.bus, open.key);
    return open.endpoints->Made();
  }
  if (verb == "close") {
    open.endpoints.reset();
    buses_.erase(found);
    return std::string();
  }
  if (open.endpoints == nullptr) {
    return Error{ErrorCode::kNotFound, "no endpoints of " + name};
  }
  if (verb == "write") {
    std::uint32_t sequence = 1;
    words >> sequence;
    open.endpoints->Write(open.key, sequence);
    return std::string();
  }
  if (verb == "why") {
    std::string endpoint;
    words >> endpoint;
    return open.endpoints->Why(endpoint);
  }
  return verb == "keys" ? open.endpoints->Keys() : open.endpoints->Counts();
}

}  // namespace limbcast::security_test
