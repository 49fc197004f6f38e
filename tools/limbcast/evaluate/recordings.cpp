#include "tools/limbcast/evaluate/recordings.hpp"

#include <algorithm>
#include <system_error>

namespace limbcast::tool {

Result<std::vector<std::filesystem::path>> RecordingsIn(const std::string& data) {
  std::error_code failed;
  if (!std::filesystem::is_directory(data, failed)) {
    return std::vector<std::filesystem::path>{data};
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(data, failed)) {
    const auto extension = entry.path().extension();
    if (extension == ".hdf5" || extension == ".h5" || extension == ".csv") {
      files.push_back(entry.path());
    }
  }
  if (files.empty()) {
    return Error{ErrorCode::kNotFound,
                 "--data " + data + " holds no recording (.hdf5, .h5 or .csv)"};
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace limbcast::tool
