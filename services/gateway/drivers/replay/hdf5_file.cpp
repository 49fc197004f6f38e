#include "services/gateway/drivers/replay/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <utility>

namespace limbcast::gateway {

namespace {

constexpr std::size_t kMaxValues = 200'000'000;  // 1.6 GB; no recording of ours comes near

// A handle of the library with the function that gives it back.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (ok()) {
      close_(id_);
    }
  }
  [[nodiscard]] bool ok() const { return id_ >= 0; }
  [[nodiscard]] hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void SilenceLibrary() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// The innermost reason on the library's error stack, e.g. "truncated file: eof = 1000, ...".
std::string InnermostReason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* entry, void* out) -> herr_t {
        if (n == 0 && entry->desc != nullptr) {
          *static_cast<std::string*>(out) = entry->desc;
        }
        return 0;
      },
      &reason);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  return reason.empty() ? "no reason given" : reason;
}

bool IsNumber(hid_t type) {
  const H5T_class_t type_class = H5Tget_class(type);
  return type_class == H5T_FLOAT || type_class == H5T_INTEGER || type_class == H5T_ENUM;
}

}  // namespace

Result<Hdf5File> Hdf5File::Open(const std::filesystem::path& path) {
  SilenceLibrary();
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) {
    return Error{ErrorCode::kCorruptData,
                 "cannot open HDF5 file " + path.string() + ": " + InnermostReason()};
  }
  return Hdf5File(path, file);
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) {
    H5Fclose(file_);
  }
}

Error Hdf5File::MakeError(ErrorCode code, const std::string& what) const {
  return Error{code, path_.string() + ": " + what};
}

bool Hdf5File::Has(const std::string& name) const {
  // H5Lexists fails when a group on the way is missing: ask for each part.
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    if (H5Lexists(file_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) {
      return false;
    }
    if (end == std::string::npos) {
      return true;
    }
  }
}

std::vector<std::string> Hdf5File::Groups() const {
  std::vector<std::string> names;
  hsize_t index = 0;
  H5Literate(
      file_, H5_INDEX_NAME, H5_ITER_INC, &index,
      [](hid_t group, const char* name, const H5L_info_t* /*info*/, void* out) -> herr_t {
        const Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
        if (object.ok() && H5Iget_type(object.get()) == H5I_GROUP) {
          static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        }
        return 0;
      },
      &names);
  return names;
}

Result<NumberTable> Hdf5File::ReadTable(const std::string& name, std::size_t columns) const {
  if (!Has(name)) {
    return MakeError(ErrorCode::kNotFound, "dataset " + name + " is missing");
  }
  const Handle dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.ok()) {
    return MakeError(ErrorCode::kCorruptData, name + " is no dataset: " + InnermostReason());
  }
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (!type.ok() || !IsNumber(type.get())) {
    return MakeError(ErrorCode::kCorruptData, "dataset " + name + " must hold numbers");
  }

  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  std::array<hsize_t, 2> shape{0, 1};
  const int rank = space.ok() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  const bool rank_fits = rank == 2 || (rank == 1 && columns == 1);
  if (!rank_fits || H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr) < 0 ||
      shape[1] != columns) {
    std::string found = "of rank " + std::to_string(rank);
    if (rank_fits) {
      found = std::to_string(shape[0]) + " x " + std::to_string(shape[1]);
    }
    return MakeError(ErrorCode::kCorruptData, "dataset " + name + " must be N x " +
                                                  std::to_string(columns) + ", is " + found);
  }
  if (shape[0] > kMaxValues / columns) {
    return MakeError(ErrorCode::kCorruptData,
                     "dataset " + name + " has " + std::to_string(shape[0]) + " rows, at most " +
                         std::to_string(kMaxValues / columns) + " are read");
  }

  NumberTable table{.rows = shape[0], .columns = columns, .values = {}};
  table.values.resize(table.rows * columns);
  if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
              table.values.data()) < 0) {
    return MakeError(ErrorCode::kCorruptData,
                     "dataset " + name + " cannot be read: " + InnermostReason());
  }
  return table;
}

Result<double> Hdf5File::ReadNumberAttribute(const std::string& name) const {
  if (H5Aexists(file_, name.c_str()) <= 0) {
    return MakeError(ErrorCode::kNotFound, "attribute " + name + " is missing");
  }
  const Handle attribute(H5Aopen(file_, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle type(attribute.ok() ? H5Aget_type(attribute.get()) : -1, H5Tclose);
  const Handle space(attribute.ok() ? H5Aget_space(attribute.get()) : -1, H5Sclose);
  double value = 0.0;
  if (!type.ok() || !IsNumber(type.get()) || !space.ok() ||
      H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
    return MakeError(ErrorCode::kCorruptData, "attribute " + name + " must be one number");
  }
  return value;
}

Result<double> Hdf5File::ReadSamplingRate_hz() const {
  constexpr double kMaxRate_hz = 100'000.0;
  Result<double> rate_hz = ReadNumberAttribute("sampling_rate");
  if (rate_hz && !(*rate_hz > 0.0 && *rate_hz <= kMaxRate_hz)) {
    return MakeError(
        ErrorCode::kCorruptData,
        "attribute sampling_rate must be in (0, 100000], is " + std::to_string(*rate_hz));
  }
  return rate_hz;
}

}  // namespace limbcast::gateway
