#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::config {

namespace internal {
struct Document;
struct Node;
}  // namespace internal

/// One table of a configuration file. Cheap to copy; valid while its ConfigFile (or a copy) lives.
///
/// Every Read names a key, what it is when the file does not say, and its range, and gives the
/// value. What is wrong is remembered in the file (the first one wins, the default is returned), so
/// a whole struct is read without a branch and ConfigFile::Finish is asked once:
///
///   FusionConfig config;
///   const Section section = file.Get("fusion");
///   config.workers = section.Read("workers", config.workers, 1, 64);
///   config.max_gap_s = section.Read("max_gap_s", config.max_gap_s, 0.0, 10.0);
///   if (const Status read = file.Finish(); !read) return read.error();
///       // fusion.toml:12: fusion.workers must be in [1, 64], is 0
class Section {
 public:
  /// A whole number in [min, max].
  template <typename T>
  requires std::integral<T> &&(!std::same_as<T, bool>) [[nodiscard]] T
      Read(std::string_view key, T fallback, std::type_identity_t<T> min,
           std::type_identity_t<T> max) const {
    return static_cast<T>(ReadInteger(key, AsInteger(fallback), AsInteger(min), AsInteger(max)));
  }

  /// A finite number in [min, max]; whole numbers are accepted.
  [[nodiscard]] double Read(std::string_view key, double fallback, double min, double max) const;

  [[nodiscard]] bool Read(std::string_view key, bool fallback) const;

  /// Text of at most `max_length` characters.
  [[nodiscard]] std::string Read(std::string_view key, std::string fallback,
                                 std::size_t max_length) const;
  [[nodiscard]] std::string Read(std::string_view key, const char* fallback,
                                 std::size_t max_length) const {
    return Read(key, std::string(fallback), max_length);
  }

  /// One of the names in `allowed`; the error lists them.
  template <typename Enum>
  [[nodiscard]] Enum Read(std::string_view key, Enum fallback,
                          std::span<const std::pair<std::string_view, Enum>> allowed) const {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : allowed) {
      names.push_back(name);
    }
    const std::optional<std::size_t> chosen = ReadChoice(key, names);
    return chosen ? allowed[*chosen].second : fallback;
  }

  /// A list of texts.
  [[nodiscard]] std::vector<std::string> Read(std::string_view key,
                                              std::vector<std::string> fallback) const;

  /// A list of numbers, each in [min, max]; `size` of them when that is not 0.
  [[nodiscard]] std::vector<double> ReadNumbers(std::string_view key, std::vector<double> fallback,
                                                double min, double max, std::size_t size = 0) const;

  /// Any single value as the text that a person would write ("0.3", "true", "quest"), for settings
  /// that the reader of this section does not know by name (filter parameters).
  [[nodiscard]] std::string ReadAnyAsText(std::string_view key) const;

  /// The table under `name`; an empty one when there is none.
  [[nodiscard]] Section Get(std::string_view name) const;

  /// The tables of an array of tables ([[name]]); none when there are none.
  [[nodiscard]] std::vector<Section> GetAll(std::string_view name) const;

  [[nodiscard]] bool Has(std::string_view key) const;
  /// All keys of this table, in the order of the alphabet.
  [[nodiscard]] std::vector<std::string> Keys() const;
  /// "fusion.filter": where this table is, for messages. "" for the root.
  [[nodiscard]] const std::string& path() const;

  /// Remembers a failure that the caller found, with file, line and key in front:
  /// "fusion.toml:7: filter.name <message>".
  void Fail(std::string_view key, std::string_view message) const;

 private:
  friend class ConfigFile;
  explicit Section(std::shared_ptr<internal::Node> node) : node_(std::move(node)) {}

  template <std::integral T>
  static std::int64_t AsInteger(T value) {
    return std::cmp_greater(value, std::numeric_limits<std::int64_t>::max())
               ? std::numeric_limits<std::int64_t>::max()
               : static_cast<std::int64_t>(value);
  }
  [[nodiscard]] std::int64_t ReadInteger(std::string_view key, std::int64_t fallback,
                                         std::int64_t min, std::int64_t max) const;
  [[nodiscard]] std::optional<std::size_t> ReadChoice(
      std::string_view key, std::span<const std::string_view> names) const;

  std::shared_ptr<internal::Node> node_;
};

/// A TOML file that is being read. Thread-compatible.
class ConfigFile {
 public:
  /// No file: every Read gives its default.
  ConfigFile();

  /// Fails with kNotFound (no such file) or kInvalidArgument (syntax, with file and line).
  [[nodiscard]] static Result<ConfigFile> Load(const std::filesystem::path& path);
  /// The same from text; `name` stands for the file in messages.
  [[nodiscard]] static Result<ConfigFile> Parse(std::string_view text, std::string name);

  /// Puts what another file says over what this one says, table by table. Its lines keep their
  /// file's name in messages.
  void PutOver(ConfigFile other);

  /// Puts "key.path=value" (a line of TOML; a bare word counts as text) over what the file says, as
  /// the --set option does.
  [[nodiscard]] Status Override(std::string_view assignment);

  [[nodiscard]] Section Root() const;
  /// The table under `name`, e.g. "fusion".
  [[nodiscard]] Section Get(std::string_view name) const { return Root().Get(name); }

  /// The first failure of all reads, else the first key of the whole file that nobody asked for
  /// (with its line), else Ok.
  [[nodiscard]] Status Finish() const;

 private:
  explicit ConfigFile(std::shared_ptr<internal::Document> document)
      : document_(std::move(document)) {}
  std::shared_ptr<internal::Document> document_;
};

}  // namespace limbcast::config
