#include "common/config/toml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/config/toml_ascii.hpp"

namespace limbcast::config::internal {

std::string PlaceOf(const Document& document, const toml::node* node) {
  if (node == nullptr || node->source().begin.line == 0) {
    return document.name;
  }
  const std::string name = node->source().path == nullptr ? document.name : *node->source().path;
  return name.starts_with(kOverride) ? name : fmt::format("{}:{}", name, node->source().begin.line);
}

std::string Node::PathOf(std::string_view key) const {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

toml::node* Node::Find(std::string_view key) const {
  toml::node* found = table == nullptr ? nullptr : table->get(key);
  if (found != nullptr) {
    document->known.insert(found);
  }
  return found;
}

void Node::Fail(const toml::node* at, std::string_view key, std::string_view message) const {
  if (document->first_error) {
    return;
  }
  const std::string where = PathOf(key);
  // Messages of other rooms may name the thing themselves.
  const bool named = message.starts_with(where);
  document->first_error = Error{ErrorCode::kInvalidArgument,
                                fmt::format("{}: {}{}{}", PlaceOf(*document, at),
                                            named ? "" : where, named ? "" : " ", message)};
}

std::string TextOf(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return fmt::format("\"{}\"", text->get());
  }
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  std::string result = out.str();
  std::replace(result.begin(), result.end(), '\n', ' ');
  return result;
}

std::optional<Error> FindUnknown(const Document& document, const toml::node& node,
                                 const std::string& path) {
  // Tables and arrays of tables only: the elements of a list of values belong to their key.
  if (const auto* array = node.as_array(); array != nullptr && array->is_array_of_tables()) {
    for (const toml::node& child : *array) {
      if (auto error = FindUnknown(document, child, path)) {
        return error;
      }
    }
  }
  const auto* table = node.as_table();
  if (table == nullptr) {
    return std::nullopt;
  }
  std::vector<std::pair<std::string, const toml::node*>> children;
  for (const auto& [key, child] : *table) {
    children.emplace_back(
        path.empty() ? std::string(key.str()) : path + "." + std::string(key.str()), &child);
  }
  std::ranges::sort(children, {},
                    [](const auto& child) { return child.second->source().begin.line; });
  for (const auto& [child_path, child] : children) {
    if (!document.known.contains(child)) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("{}: {} is not a known key", PlaceOf(document, child), child_path)};
    }
    if (auto error = FindUnknown(document, *child, child_path)) {
      return error;
    }
  }
  return std::nullopt;
}

void Merge(toml::table& into, toml::table& from) {
  for (auto&& [key, value] : from) {
    toml::node* existing = into.get(key);
    if (existing != nullptr && existing->is_table() && value.is_table()) {
      Merge(*existing->as_table(), *value.as_table());
    } else {
      into.insert_or_assign(key, std::move(value));
    }
  }
}

Result<toml::table> ParseToml(std::string_view text, const std::string& name) {
  // TOML has no control characters but these three; toml++ 3.3 takes some of the others for the
  // beginning of a key (found by tests/fuzz).
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') ||
           c == 0x7F;
  };
  if (const auto control = std::find_if(text.begin(), text.end(), is_control);
      control != text.end()) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("{}:{}: control character 0x{:02x}, TOML allows none", name,
                             1 + std::count(text.begin(), control, '\n'), *control)};
  }
  const auto ascii = AsciiToml(text, name);
  if (!ascii.ok()) {
    return ascii.error();
  }
  try {  // the parser throws; nothing thrown leaves this room
    return toml::parse(*ascii, name);
  } catch (const toml::parse_error& error) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("{}:{}: {}", name, error.source().begin.line, error.description())};
  }
}

}  // namespace limbcast::config::internal
