#include "tools/limbcast/echo_command.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include "common/runtime/stop_signal.hpp"
#include "tools/limbcast/json/topic_json.hpp"
#include "tools/limbcast/live_bus.hpp"

namespace limbcast::tool {
namespace {

struct EchoOptions {
  std::string topic;
  std::uint64_t count = 0;  // 0 = no end
  double timeout_s = 0.0;   // 0 = no end
};

// Prints from the bus' threads, one line at a time, and asks to stop when it has had enough.
class LinePrinter {
 public:
  LinePrinter(std::uint64_t limit, runtime::StopSignal& stop) : limit_(limit), stop_(stop) {}
  void Print(const nlohmann::json& value) {
    const std::lock_guard lock(mutex_);
    if (limit_ != 0 && printed_ == limit_) {
      return;
    }
    // A reader of the pipe that went away is an end, not an error.
    if (fmt::print("{}\n", value.dump()); std::fflush(stdout) != 0 || ++printed_ == limit_) {
      stop_.Trigger();
    }
  }
  [[nodiscard]] std::uint64_t printed() {
    const std::lock_guard lock(mutex_);
    return printed_;
  }

 private:
  const std::uint64_t limit_;
  runtime::StopSignal& stop_;
  std::mutex mutex_;
  std::uint64_t printed_ = 0;
};

template <typename T>
Result<std::shared_ptr<void>> Subscribe(bus::Bus& bus, LinePrinter& printer) {
  auto reader = bus.MakeReader<T>(
      {.on_sample = [&printer](const T& value,
                               const bus::SampleInfo&) { printer.Print(ToJson(value)); },
       .on_disposed =
           [&printer](const T& key) {
             printer.Print({{"disposed", KeyToJson(key)}});
           }});
  if (!reader) {
    return reader.error();
  }
  return std::shared_ptr<void>(std::move(*reader));
}

template <typename... Ts>
std::string TopicNames(std::tuple<Ts...>*) {
  std::string names;
  ((names += (names.empty() ? "" : ", ") + std::string(bus::Topic<Ts>::kShortName)), ...);
  return names;
}

// Subscribes to the one topic of that name.
template <typename... Ts>
Result<std::shared_ptr<void>> SubscribeByName(std::tuple<Ts...>* topics, const std::string& name,
                                              bus::Bus& bus, LinePrinter& printer) {
  Result<std::shared_ptr<void>> result =
      Error{ErrorCode::kInvalidArgument,
            fmt::format("TOPIC must be one of {}, is '{}'", TopicNames(topics), name)};
  ((name == bus::Topic<Ts>::kShortName ? void(result = Subscribe<Ts>(bus, printer)) : void()), ...);
  return result;
}

int Echo(const service::ServiceCommandLine& line, const EchoOptions& options) {
  runtime::StopSignal stop;
  LinePrinter printer(options.count, stop);
  const auto bus = OpenLiveBus(line);
  if (!bus) {
    return line.Fail(bus.error());
  }
  const auto reader =
      SubscribeByName(static_cast<bus::AllTopics*>(nullptr), options.topic, **bus, printer);
  if (!reader) {
    return line.Fail(reader.error());
  }
  if (options.timeout_s > 0.0) {
    stop.WaitFor(DurationFromSeconds(options.timeout_s));
  } else {
    stop.Wait();
  }
  if (options.count > 0 && printer.printed() < options.count && options.timeout_s > 0.0) {
    return line.Fail(
        {ErrorCode::kTimeout, fmt::format("{}: {} samples in {} s, expected {}", options.topic,
                                          printer.printed(), options.timeout_s, options.count)});
  }
  return 0;
}

}  // namespace

SubCommand AddEchoCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<EchoOptions>();
  CLI::App* app =
      line.app().add_subcommand("echo", "Print the samples of a topic, one JSON a line");
  app->add_option("TOPIC", options->topic, TopicNames(static_cast<bus::AllTopics*>(nullptr)))
      ->required();
  app->add_option("--count", options->count, "End after so many samples");
  app->add_option("--timeout", options->timeout_s, "End after so many seconds")
      ->check(CLI::Range(0.0, 1e9));
  return {.app = app, .run = [&line, options] { return Echo(line, *options); }};
}

}  // namespace limbcast::tool
