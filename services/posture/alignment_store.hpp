#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "common/base/result.hpp"
#include "common/body/body_definition.hpp"

namespace limbcast::posture {

/// Keeps alignment and dimensions of each body in one small TOML file, so that a restart of the
/// service asks nobody to stand in the reference pose again; and profiles, the same under a
/// person's name, which follow that person to any body. Thread-compatible; one body's file is used
/// by one thread at a time.
class AlignmentStore {
 public:
  static constexpr std::size_t kMaxProfileName = 48;  // characters

  /// An empty folder name: nothing is kept.
  explicit AlignmentStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Makes the folder and tries to write into it.
  [[nodiscard]] Status Prepare() const;

  /// `<folder>/body_<id>.toml`.
  [[nodiscard]] std::filesystem::path PathOf(BodyId body_id) const;

  /// Replaces the file as a whole (config::ReplaceDurably). One that is there and cannot be read
  /// is kept as `<name>.refused`.
  [[nodiscard]] Status Save(const body::BodyDefinition& definition) const;

  /// Puts what was saved over `definition` (dimensions, sensors, offsets, revision); segments that
  /// only one of the two has are left alone. False: nothing was saved for this body. Fails
  /// (kCorruptData, kUnavailable) for a file that is cut off, of another version or body, or holds
  /// a value that cannot be; `definition` is unchanged then.
  [[nodiscard]] Result<bool> Load(body::BodyDefinition& definition) const;

  /// `<folder>/profile_<name>.toml`; characters other than letters, digits, '-' and '_' become '_'.
  [[nodiscard]] std::filesystem::path ProfilePathOf(std::string_view name) const;
  [[nodiscard]] bool HasProfile(std::string_view name) const;

  /// Replaces the profile as a whole, as Save. Without a folder there is nowhere to keep it:
  /// kUnavailable. kInvalidArgument for a name that is empty or longer than kMaxProfileName.
  [[nodiscard]] Status SaveProfile(std::string_view name,
                                   const body::BodyDefinition& definition) const;

  /// Puts a profile over `definition`: dimensions, and the alignment of each sensor that sits on
  /// the segment for which the profile knows it. An alignment belongs to sensor and segment: one
  /// that sits elsewhere now, or another one in its place, is left as it is. Gives the number of
  /// aligned segments. Fails as Load, and with kNotFound; `definition` is unchanged then.
  [[nodiscard]] Result<std::size_t> LoadProfile(std::string_view name,
                                                body::BodyDefinition& definition) const;

 private:
  [[nodiscard]] Status Replace(const std::filesystem::path& path,
                               const body::BodyDefinition& definition) const;

  std::filesystem::path folder_;
};

}  // namespace limbcast::posture
