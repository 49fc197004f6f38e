#include "tools/limbcast/evaluate/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace limbcast::tool {

void ForEachIndex(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      work(i);
    }
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> others;
  for (std::size_t thread = 1; thread < std::min(cores, count); ++thread) {
    others.emplace_back(run);
  }
  run();
}

}  // namespace limbcast::tool
