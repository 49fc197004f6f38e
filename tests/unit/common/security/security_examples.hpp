#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "common/security/create.hpp"

namespace limbcast::security::testing {

using namespace std::chrono_literals;

/// Noon of some day.
inline const Time kNow{std::chrono::duration_cast<Duration>(std::chrono::seconds(1'790'000'000))};
inline const Validity kToday{kNow - 12h, kNow + 12h};

inline CreateOptions ForToday() {
  CreateOptions options;
  options.authority = {kNow - 24h, kNow + 240h};
  options.identities = kToday;
  return options;
}

inline std::string Read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void Replace(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

}  // namespace limbcast::security::testing
