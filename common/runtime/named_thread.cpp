#include "common/runtime/named_thread.hpp"

#include <pthread.h>
#include <sys/prctl.h>

#include <csignal>
#include <utility>

namespace limbcast::runtime {

namespace {
constexpr std::size_t kMaxNameLength = 15;  // of the kernel, without the final zero
constexpr unsigned long kTimerSlack_ns = 1000;
}  // namespace

void SetThisThreadName(const std::string& name) {
  pthread_setname_np(pthread_self(), name.substr(0, kMaxNameLength).c_str());
}

NamedThread::NamedThread(std::string name, std::function<void()> body) {
  // The new thread inherits the mask, so there is no moment in which it could take a signal.
  sigset_t stop_signals;
  sigset_t before;
  sigemptyset(&stop_signals);
  sigaddset(&stop_signals, SIGINT);
  sigaddset(&stop_signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop_signals, &before);
  thread_ = std::thread([name = std::move(name), body = std::move(body)] {
    SetThisThreadName(name);
    prctl(PR_SET_TIMERSLACK, kTimerSlack_ns, 0, 0, 0);
    body();
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

NamedThread& NamedThread::operator=(NamedThread&& other) noexcept {
  if (this != &other) {
    Join();
    thread_ = std::move(other.thread_);
  }
  return *this;
}

NamedThread::~NamedThread() { Join(); }

void NamedThread::Join() {
  if (thread_.joinable()) {
    thread_.join();
  }
}

}  // namespace limbcast::runtime
