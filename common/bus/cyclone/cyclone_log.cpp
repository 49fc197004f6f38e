#include "common/bus/cyclone/cyclone_log.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>

#include <algorithm>
#include <mutex>

namespace limbcast::bus::cyclone {
namespace {

// The library's log is one for the process, so is this.
struct LastError {
  std::mutex mutex;
  std::string message;
};

LastError& TheLastError() {
  static auto* last_error = new LastError();  // NOLINT: the library may log while main ends
  return *last_error;
}

void Keep(void* /*argument*/, const dds_log_data_t* data) {
  if ((data->priority & (DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING)) == 0) {
    return;
  }
  LastError& last = TheLastError();
  const std::scoped_lock lock(last.mutex);
  last.message = data->message;
  while (!last.message.empty() && last.message.back() == '\n') {
    last.message.pop_back();
  }
  std::replace(last.message.begin(), last.message.end(), '\n', ' ');
}

}  // namespace

void QuietCycloneLog() {
  static std::once_flag once;
  std::call_once(once, [] { dds_set_log_sink(&Keep, nullptr); });
}

std::string LastCycloneError() {
  LastError& last = TheLastError();
  const std::scoped_lock lock(last.mutex);
  return last.message;
}

}  // namespace limbcast::bus::cyclone
