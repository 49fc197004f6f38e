#pragma once

#include <toml++/toml.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

/// What stands behind ConfigFile and Section. Only this room includes it: the parser stays inside.
namespace limbcast::config::internal {

/// In front of what the command line put over a file, where the file's name would be.
inline constexpr std::string_view kOverride = "--set ";

struct Document {
  std::string name;
  toml::table root;
  std::optional<Error> first_error;
  std::set<const toml::node*> known;  ///< nodes that somebody asked for
};

/// "fusion.toml:12", or "--set fusion.workers=0" for what the command line put there.
[[nodiscard]] std::string PlaceOf(const Document& document, const toml::node* node);

/// One table of a document and where it is.
struct Node {
  std::shared_ptr<Document> document;
  toml::table* table = nullptr;  ///< null: not in the file
  std::string path;

  [[nodiscard]] std::string PathOf(std::string_view key) const;
  /// The node of a key, which then counts as known; null when there is none.
  [[nodiscard]] toml::node* Find(std::string_view key) const;
  /// Remembers "place: path.key message", unless something failed before.
  void Fail(const toml::node* at, std::string_view key, std::string_view message) const;
};

/// What stands in the file, on one line, for messages.
[[nodiscard]] std::string TextOf(const toml::node& node);

/// The first key below `node` that nobody asked for, in the order of the file.
[[nodiscard]] std::optional<Error> FindUnknown(const Document& document, const toml::node& node,
                                               const std::string& path);

/// Moves `from` over `into`, table by table.
void Merge(toml::table& into, toml::table& from);

/// Fails with kInvalidArgument naming the line.
[[nodiscard]] Result<toml::table> ParseToml(std::string_view text, const std::string& name);

}  // namespace limbcast::config::internal
