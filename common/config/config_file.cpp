#include "common/config/config_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>

#include "common/config/toml_document.hpp"

namespace limbcast::config {

using internal::TextOf;

// ---------------------------------------------------------------------------------------- Section

std::int64_t Section::ReadInteger(std::string_view key, std::int64_t fallback, std::int64_t min,
                                  std::int64_t max) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return fallback;
  }
  const auto* value = node->as_integer();
  if (value == nullptr) {
    node_->Fail(node, key,
                fmt::format("must be a whole number in [{}, {}], is {}", min, max, TextOf(*node)));
    return fallback;
  }
  if (value->get() < min || value->get() > max) {
    node_->Fail(node, key, fmt::format("must be in [{}, {}], is {}", min, max, value->get()));
    return fallback;
  }
  return value->get();
}

double Section::Read(std::string_view key, double fallback, double min, double max) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return fallback;
  }
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value) {
    node_->Fail(node, key,
                fmt::format("must be a number in [{}, {}], is {}", min, max, TextOf(*node)));
    return fallback;
  }
  if (!(*value >= min && *value <= max) || !std::isfinite(*value)) {
    node_->Fail(node, key, fmt::format("must be in [{}, {}], is {}", min, max, *value));
    return fallback;
  }
  return *value;
}

bool Section::Read(std::string_view key, bool fallback) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return fallback;
  }
  if (const auto* value = node->as_boolean()) {
    return value->get();
  }
  node_->Fail(node, key, fmt::format("must be true or false, is {}", TextOf(*node)));
  return fallback;
}

std::string Section::Read(std::string_view key, std::string fallback,
                          std::size_t max_length) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return fallback;
  }
  const auto* value = node->as_string();
  if (value == nullptr) {
    node_->Fail(node, key, fmt::format("must be a text in quotes, is {}", TextOf(*node)));
    return fallback;
  }
  if (value->get().size() > max_length) {
    node_->Fail(
        node, key,
        fmt::format("must have at most {} characters, has {}", max_length, value->get().size()));
    return fallback;
  }
  return value->get();
}

std::optional<std::size_t> Section::ReadChoice(std::string_view key,
                                               std::span<const std::string_view> names) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const auto* value = node->as_string();
  const auto found =
      value == nullptr ? names.end() : std::find(names.begin(), names.end(), value->get());
  if (found == names.end()) {
    node_->Fail(node, key,
                fmt::format("must be one of {}, is {}", fmt::join(names, ", "), TextOf(*node)));
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<std::string> Section::Read(std::string_view key,
                                       std::vector<std::string> fallback) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return fallback;
  }
  const auto* array = node->as_array();
  std::vector<std::string> result;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      if (const auto* text = element.as_string()) {
        result.push_back(text->get());
      }
    }
  }
  if (array == nullptr || result.size() != array->size()) {
    node_->Fail(node, key, fmt::format("must be a list of texts, is {}", TextOf(*node)));
    return fallback;
  }
  return result;
}

std::vector<double> Section::ReadNumbers(std::string_view key, std::vector<double> fallback,
                                         double min, double max, std::size_t size) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return fallback;
  }
  const auto* array = node->as_array();
  std::vector<double> result;
  if (array != nullptr) {
    for (const toml::node& element : *array) {
      const std::optional<double> value =
          element.is_number() ? element.value<double>() : std::nullopt;
      if (value && std::isfinite(*value) && *value >= min && *value <= max) {
        result.push_back(*value);
      }
    }
  }
  if (array == nullptr || result.size() != array->size() || (size != 0 && result.size() != size)) {
    node_->Fail(
        node, key,
        fmt::format("must be a list of {}numbers in [{}, {}], is {}",
                    size == 0 ? std::string() : fmt::format("{} ", size), min, max, TextOf(*node)));
    return fallback;
  }
  return result;
}

std::string Section::ReadAnyAsText(std::string_view key) const {
  const toml::node* node = node_->Find(key);
  if (node == nullptr) {
    return {};
  }
  if (const auto* text = node->as_string()) {
    return text->get();
  }
  if (const auto* number = node->as_floating_point()) {
    return fmt::format("{}", number->get());
  }
  if (!node->is_value()) {
    node_->Fail(node, key, fmt::format("must be a single value, is {}", TextOf(*node)));
    return {};
  }
  return TextOf(*node);
}

Section Section::Get(std::string_view name) const {
  auto child = std::make_shared<internal::Node>();
  child->document = node_->document;
  child->path = node_->PathOf(name);
  if (toml::node* node = node_->Find(name)) {
    child->table = node->as_table();
    if (child->table == nullptr) {
      node_->Fail(node, name, fmt::format("must be a table, is {}", TextOf(*node)));
    }
  }
  return Section(std::move(child));
}

std::vector<Section> Section::GetAll(std::string_view name) const {
  std::vector<Section> result;
  toml::node* node = node_->Find(name);
  if (node == nullptr) {
    return result;
  }
  toml::array* array = node->as_array();
  if (array == nullptr || (!array->empty() && !array->is_array_of_tables())) {
    node_->Fail(node, name,
                fmt::format("must be a list of tables ([[{}]]), is {}", node_->PathOf(name),
                            TextOf(*node)));
    return result;
  }
  for (std::size_t i = 0; i < array->size(); ++i) {
    auto child = std::make_shared<internal::Node>();
    child->document = node_->document;
    child->table = (*array)[i].as_table();
    child->path = fmt::format("{}[{}]", node_->PathOf(name), i);
    node_->document->known.insert(child->table);
    result.push_back(Section(std::move(child)));
  }
  return result;
}

bool Section::Has(std::string_view key) const {
  return node_->table != nullptr && node_->table->contains(key);
}

std::vector<std::string> Section::Keys() const {
  std::vector<std::string> keys;
  if (node_->table != nullptr) {
    for (const auto& [key, value] : *node_->table) {
      keys.emplace_back(key.str());
    }
  }
  std::ranges::sort(keys);
  return keys;
}

const std::string& Section::path() const { return node_->path; }

void Section::Fail(std::string_view key, std::string_view message) const {
  node_->Fail(node_->table == nullptr ? nullptr : node_->Find(key), key, message);
}

// ------------------------------------------------------------------------------------- ConfigFile

ConfigFile::ConfigFile() : document_(std::make_shared<internal::Document>()) {
  document_->name = "defaults";
}

Result<ConfigFile> ConfigFile::Load(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return Error{
        ErrorCode::kNotFound,
        fmt::format("configuration file {} does not exist or is not a file", path.string())};
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    return Error{ErrorCode::kNotFound,
                 fmt::format("configuration file {} cannot be read", path.string())};
  }
  return Parse(text.str(), path.string());
}

Result<ConfigFile> ConfigFile::Parse(std::string_view text, std::string name) {
  Result<toml::table> table = internal::ParseToml(text, name);
  if (!table) {
    return table.error();
  }
  auto document = std::make_shared<internal::Document>();
  document->name = std::move(name);
  document->root = std::move(*table);
  return ConfigFile(std::move(document));
}

void ConfigFile::PutOver(ConfigFile other) {
  internal::Merge(document_->root, other.document_->root);
}

Status ConfigFile::Override(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == 0 || equals == std::string_view::npos) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("--set must be KEY=VALUE, is \"{}\"", assignment)};
  }
  const std::string name = fmt::format("{}{}", internal::kOverride, assignment);
  Result<toml::table> table = internal::ParseToml(assignment, name);
  if (!table) {  // a bare word: --set filter.name=tqt
    const std::string quoted =
        fmt::format("{}=\"{}\"", assignment.substr(0, equals), assignment.substr(equals + 1));
    table = internal::ParseToml(quoted, name);
    if (!table) {
      return table.error();
    }
  }
  internal::Merge(document_->root, *table);
  return Ok();
}

Section ConfigFile::Root() const {
  auto node = std::make_shared<internal::Node>();
  node->document = document_;
  node->table = &document_->root;
  return Section(std::move(node));
}

Status ConfigFile::Finish() const {
  if (document_->first_error) {
    return *document_->first_error;
  }
  if (auto unknown = internal::FindUnknown(*document_, document_->root, "")) {
    return *unknown;
  }
  return Ok();
}

}  // namespace limbcast::config
