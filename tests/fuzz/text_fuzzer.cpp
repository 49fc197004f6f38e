// Every reader of text files: settings, calibrations, sessions, CSV and Xsens recordings. The first
// byte picks the reader. Any text must give a value or an error.
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/config/config_file.hpp"
#include "services/gateway/calibration_file.hpp"
#include "services/gateway/drivers/replay/csv_reader.hpp"
#include "services/gateway/drivers/replay/xsens_reader.hpp"
#include "services/session/session_store.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace limbcast;
  if (size == 0) {
    return 0;
  }
  const std::string text(data + 1, data + size);
  switch (data[0] % 5) {
    case 0: {
      const auto file = config::ConfigFile::Parse(text, "fuzz.toml");
      if (file.ok()) {
        (void)file->Get("gateway").Read("speed", 1.0, 0.0, 2.0);
        (void)file->Finish();
      }
      break;
    }
    case 1:
      (void)gateway::CalibrationFromToml(text, "fuzz.toml");
      break;
    case 2:
      (void)session::FromToml(text, "fuzz.toml");
      break;
    case 3:
      (void)gateway::ReadCsv(text, "fuzz.csv", "fuzz", {});
      break;
    default:
      (void)gateway::ReadXsensText(
          {{.name = "MT_00B42268.txt", .serial = "00B42268", .text = text}}, {});
  }
  return 0;
}
