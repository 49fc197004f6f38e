// Writes seeds: whole values of every topic for cdr_fuzzer, state files for text_fuzzer. Run it
// when a topic or such a file changes:
//   build/fuzz/fuzz/fuzz_make_corpus tests/fuzz/corpus
#include <cstdio>
#include <filesystem>
#include <fstream>
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
      WriteText(corpus / "text" / "calibration", 1,
                limbcast::gateway::CalibrationToToml(calibration)) &&
      WriteText(corpus / "text" / "sessions", 2, limbcast::session::ToToml({}));
  return written ? 0 : 1;
}
