#include "common/service/health_publisher.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <random>
#include <utility>

#include "common/runtime/process_usage.hpp"

namespace limbcast::service {

namespace {

constexpr std::size_t kMaxErrorLength = 255;  // bound of the wire type

std::string HostName() {
  std::array<char, 65> name{};  // 64 is the bound of the wire type; the last byte stays zero
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::uint64_t RandomUid() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

}  // namespace

Result<std::unique_ptr<HealthPublisher>> HealthPublisher::Make(std::string role, const Clock& clock,
                                                               bus::Bus& bus, Fill fill) {
  Result<std::unique_ptr<bus::Writer<ServiceHealth>>> writer = bus.MakeWriter<ServiceHealth>();
  if (!writer) {
    return writer.error();
  }
  return std::unique_ptr<HealthPublisher>(
      new HealthPublisher(std::move(role), clock, std::move(*writer), std::move(fill)));
}

HealthPublisher::HealthPublisher(std::string role, const Clock& clock,
                                 std::unique_ptr<bus::Writer<ServiceHealth>> writer, Fill fill)
    : clock_(clock), writer_(std::move(writer)), fill_(std::move(fill)) {
  health_.process_uid = RandomUid();
  health_.role = std::move(role);
  health_.host = HostName();
  health_.pid = static_cast<std::uint32_t>(getpid());
  health_.started_at = clock_.Now();
}

void HealthPublisher::Start(Duration period) {
  thread_.emplace("health", period, [this] { Publish(); });
}

void HealthPublisher::Stop() {
  if (thread_) {
    thread_->Stop();
  }
  {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(stopped_, true)) {
      return;
    }
  }
  Publish();
}

void HealthPublisher::Publish() {
  const std::scoped_lock lock(mutex_);
  const runtime::ProcessUsage usage = runtime::ReadProcessUsage();
  health_.reported_at = clock_.Now();
  health_.cpu_seconds = usage.cpu_seconds;
  health_.rss_mib = usage.rss_mib;
  health_.values.clear();
  health_.values.push_back({"gauge.threads", static_cast<double>(usage.threads)});
  health_.latencies.clear();
  health_.last_error.clear();
  fill_(health_);
  if (health_.last_error.empty()) {
    health_.last_error = last_error_;
  }
  health_.last_error.resize(std::min(health_.last_error.size(), kMaxErrorLength));
  if (const Status written = writer_->Write(health_); !written) {
    spdlog::warn("health not published: {}", written.error().message);
  }
  writer_->Flush();
}

void HealthPublisher::SetLastError(std::string message) {
  const std::scoped_lock lock(mutex_);
  last_error_ = std::move(message);
}

}  // namespace limbcast::service
