// Writes seeds: whole values of every topic and a fragment for cdr_fuzzer, state files for
// text_fuzzer. Run it when a topic or such a file changes:
//   build/fuzz/fuzz/fuzz_make_corpus tests/fuzz/corpus
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <tuple>
#include <utility>

#include "services/gateway/calibration_file.hpp"
#include "services/session/session_store.hpp"
#include "tests/support/topic_examples.hpp"

namespace {

using limbcast::bus::AllTopics;

template <std::size_t I>
bool WriteSeed(const std::filesystem::path& folder) {
  using T = std::tuple_element_t<I, AllTopics>;
  std::ofstream file(folder / limbcast::bus::Topic<T>::kShortName, std::ios::binary);
  file.put(static_cast<char>(I));
  const std::string bytes =
      limbcast::test_support::WireBytes(limbcast::test_support::Example<T>(1, 1));
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file.good();
}

// The first fragment of a sample as Cyclone DDS sends it to Fast DDS, with the key hash.
bool WriteFragment(const std::filesystem::path& path) {
  std::string message = "RTPS";
  const auto put = [&](std::initializer_list<int> bytes, std::size_t then = 0, char fill = '\1') {
    for (const int byte : bytes) {
      message += static_cast<char>(byte);
    }
    message.append(then, fill);
  };
  put({2, 1, 1, 16}, 12);                  // version, vendor, who
  put({0x09, 1, 8, 0}, 8);                 // INFO_TS
  put({0x16, 3, 64, 0, 0, 0, 28, 0}, 28);  // DATA_FRAG: flags, length, octets to the inline QoS
  put({0x70, 0, 16, 0}, 16);               // PID_KEY_HASH
  put({1, 0, 0, 0}, 8);                    // PID_SENTINEL, the piece of the sample
  std::ofstream file(path, std::ios::binary);
  file.put(static_cast<char>(std::tuple_size_v<AllTopics>));
  file << message;
  return file.good();
}

bool WriteText(const std::filesystem::path& path, char reader, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << reader << text;
  return file.good();
}

template <std::size_t... I>
bool WriteSeeds(const std::filesystem::path& folder, std::index_sequence<I...>) {
  return (WriteSeed<I>(folder) && ...);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
    std::fputs("usage: fuzz_make_corpus FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path corpus(argv[1]);
  limbcast::sensing::SensorCalibration calibration;
  calibration.serial = "00B42268";
  const bool written =
      WriteSeeds(corpus / "cdr", std::make_index_sequence<std::tuple_size_v<AllTopics>>()) &&
      WriteFragment(corpus / "cdr" / "rtps_fragment") &&
      WriteText(corpus / "text" / "calibration", 1,
                limbcast::gateway::CalibrationToToml(calibration)) &&
      WriteText(corpus / "text" / "sessions", 2, limbcast::session::ToToml({}));
  return written ? 0 : 1;
}
