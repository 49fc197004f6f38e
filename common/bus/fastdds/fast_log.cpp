#include "common/bus/fastdds/fast_log.hpp"

#include <algorithm>
#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <mutex>

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastdds::dds::Log;
using eprosima::fastdds::dds::LogConsumer;

// The library's log is one for the process, so is this.
struct LastError {
  std::mutex mutex;
  std::string message;
};

LastError& TheLastError() {
  static LastError* last_error = new LastError();  // NOLINT: the log thread may outlive main
  return *last_error;
}

class KeepLastError final : public LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    if (entry.kind != Log::Kind::Error) {
      return;
    }
    LastError& last = TheLastError();
    const std::lock_guard lock(last.mutex);
    last.message = entry.message;
    std::replace(last.message.begin(), last.message.end(), '\n', ' ');
  }
};

}  // namespace

void QuietFastLog() {
  static std::once_flag once;
  std::call_once(once, [] {
    Log::ClearConsumers();
    Log::SetVerbosity(Log::Kind::Error);
    Log::RegisterConsumer(std::make_unique<KeepLastError>());
  });
}

std::string LastFastError() {
  Log::Flush();
  LastError& last = TheLastError();
  const std::lock_guard lock(last.mutex);
  return last.message;
}

}  // namespace limbcast::bus::fastdds
