#include "services/gateway/drivers/replay/recording_reader.hpp"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "services/gateway/drivers/replay/broad_reader.hpp"
#include "services/gateway/drivers/replay/csv_reader.hpp"
#include "services/gateway/drivers/replay/full_body_reader.hpp"
#include "services/gateway/drivers/replay/hdf5_file.hpp"
#include "services/gateway/drivers/replay/text_fields.hpp"
#include "services/gateway/drivers/replay/xsens_reader.hpp"

namespace limbcast::gateway {

namespace {

constexpr std::string_view kHdf5Signature = "\x89HDF\r\n\x1a\n";  // HDF5 file format, II.A

Result<Recording> ReadHdf5(const std::filesystem::path& path, const RecordingOptions& options) {
  const Result<Hdf5File> file = Hdf5File::Open(path);
  if (!file) {
    return file.error();
  }
  const std::string name = path.stem().string();
  if (IsBroad(*file)) {
    return ReadBroad(*file, name, options);
  }
  if (IsFullBody(*file)) {
    return ReadFullBody(*file, name, options);
  }
  return Error{ErrorCode::kUnsupported,
               path.string() +
                   ": neither a BROAD trial (/imu_gyr) nor a full-body recording (/time and "
                   "groups with imu_acc)"};
}

Result<Recording> ReadText(const std::filesystem::path& path, const RecordingOptions& options) {
  Result<std::string> text = ReadWholeFile(path);
  if (!text) {
    return text.error();
  }
  const std::string stem = path.stem().string();
  if (IsXsensText(*text)) {
    const std::size_t mark = stem.rfind('_');
    return ReadXsensText({{.name = path.string(),
                           .serial = mark == std::string::npos ? stem : stem.substr(mark + 1),
                           .text = std::move(*text)}},
                         options);
  }
  if (text->find('\0') != std::string::npos || text->find(',') == std::string::npos) {
    return Error{ErrorCode::kUnsupported,
                 path.string() + ": not a known recording (HDF5, Xsens text export or CSV)"};
  }
  return ReadCsv(*text, path.string(), stem, options);
}

Result<Recording> ReadAny(const std::filesystem::path& path, const RecordingOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return Error{ErrorCode::kNotFound, "no such recording: " + path.string()};
  }
  if (std::filesystem::is_directory(path, error)) {
    const Result<std::vector<XsensFile>> files = LoadXsensFolder(path);
    if (!files) {
      return files.error();
    }
    return ReadXsensText(*files, options);
  }
  std::ifstream file(path, std::ios::binary);
  std::array<char, kHdf5Signature.size()> begin{};
  file.read(begin.data(), begin.size());
  if (!file.is_open() || file.bad()) {
    return Error{ErrorCode::kNotFound, "cannot read recording " + path.string()};
  }
  if (std::string_view(begin.data(), begin.size()) == kHdf5Signature) {
    return ReadHdf5(path, options);
  }
  return ReadText(path, options);
}

}  // namespace

Result<Recording> ReadRecording(const std::filesystem::path& path,
                                const RecordingOptions& options) {
  Result<Recording> recording = ReadAny(path, options);
  if (!recording) {
    return recording;
  }
  recording->source = path.string();
  if (recording->ticks.empty()) {
    return Error{ErrorCode::kCorruptData, path.string() + ": holds no samples"};
  }
  MarkHeldMagnetometer(*recording);
  if (const Status assigned = Assign(*recording, options); !assigned) {
    return assigned.error();
  }
  return recording;
}

}  // namespace limbcast::gateway
