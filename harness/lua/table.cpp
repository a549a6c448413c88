#include "harness/lua/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "harness/lua/node.hpp"
#include "harness/lua/place_in_source.hpp"

namespace whirl::lua {
namespace {

std::string short_number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

std::string describe(Range range) {
  if (range.low == 0.0 && range.low_open && std::isinf(range.high)) return "must be positive";
  if (range.low == 0.0 && std::isinf(range.high)) return "must not be negative";
  std::string text = "must be";
  if (!std::isinf(range.low)) {
    text += (range.low_open ? " above " : " at least ") + short_number(range.low);
  }
  if (!std::isinf(range.high)) {
    text += (range.high_open ? " below " : " at most ") + short_number(range.high);
  }
  return text + " (SI)";
}

const char* type_name(const Node& node) {
  switch (node.type) {
    case Node::Type::boolean:
      return "true or false";
    case Node::Type::integer:
    case Node::Type::real:
      return "a bare number";
    case Node::Type::text:
      return "a text";
    case Node::Type::table:
      return "a table";
  }
  return "?";
}

bool name_char(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// The line on which `key =` stands, or 0 where it stands nowhere or in several places.
int only_line_of(const std::string& source, std::string_view key) {
  int line = 1, found = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source[i] == '\n') ++line;
    if (source.compare(i, key.size(), key) != 0 || (i > 0 && name_char(source[i - 1]))) continue;
    const auto next = source.find_first_not_of(" \t", i + key.size());
    if (next == std::string::npos || source[next] != '=' || source[next + 1] == '=') continue;
    if (found != 0) return 0;
    found = line;
  }
  return found;
}

// A value that nobody asked for, and the table that it is in. Null: there is none.
struct Unknown {
  const Node *table = nullptr, *value = nullptr;
};

Unknown unknown_below(const Node& node, const std::vector<std::string>& except = {}) {
  for (const auto& [key, child] : node.fields) {
    if (std::find(except.begin(), except.end(), key) != except.end()) continue;
    if (!child->asked) return {&node, child.get()};
    if (const Unknown found = unknown_below(*child); found.value != nullptr) return found;
  }
  for (const auto& child : node.list) {
    if (!child->asked) return {&node, child.get()};
    if (const Unknown found = unknown_below(*child); found.value != nullptr) return found;
  }
  return {};
}

std::string known_keys(const Node& table) {
  std::string all;
  for (const std::string& key : table.known) all += (all.empty() ? "known here: " : ", ") + key;
  return all;
}

std::string_view last_part(std::string_view path) {
  const auto dot = path.find_last_of('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

// Of a path. Where the file does not spell it out: of its key if that stands in one place only, or,
// of a key that is missing, of what should hold it.
int line_of(const std::string& source, const std::string& path, bool missing) {
  const SourcePlace place = place_in_source(source, path);
  if (place.exact || (missing && place.line != 0)) return place.line;
  const int only = only_line_of(source, last_part(path));
  return only != 0 ? only : place.line;
}

}  // namespace

const Node* Table::find(std::string_view key) const {
  node_->known.emplace(key);
  const auto it = node_->fields.find(key);
  if (it == node_->fields.end()) return nullptr;
  it->second->asked = true;
  return it->second.get();
}

const Node* Table::need(std::string_view key, const char* kind) const {
  const Node* node = find(key);
  if (node == nullptr) refuse(key, std::string("is missing: ") + kind + " is wanted");
  return node;
}

bool Table::has(std::string_view key) const {
  node_->known.emplace(key);
  return node_->fields.find(key) != node_->fields.end();
}

std::vector<std::string> Table::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, child] : node_->fields) names.push_back(key);
  return names;
}

std::size_t Table::size() const {
  return node_->list.size();
}

Kind Table::kind(std::string_view key) const {
  const auto it = node_->fields.find(key);
  WHIRL_CHECK(it != node_->fields.end(), key);
  switch (it->second->type) {
    case Node::Type::boolean:
      return Kind::flag;
    case Node::Type::integer:
    case Node::Type::real:
      return Kind::number;
    case Node::Type::text:
      return Kind::text;
    case Node::Type::table:
      return Kind::table;
  }
  return Kind::table;
}

double Table::in_range(double value, Range range, std::string_view key,
                       std::string_view shown) const {
  if (range.holds(value)) return value;
  refuse(key, std::string(shown) + " " + describe(range));
  return 0.0;
}

double Table::read_quantity(const Node& node, std::string_view key, Dimension dimension,
                            Range range) const {
  if (node.type == Node::Type::text) {
    const auto value = parse_quantity_as(node.text, dimension, "");
    if (value) return in_range(value.value(), range, key, "'" + node.text + "'");
    refuse(key, value.error().what, value.error().cure);
    return 0.0;
  }
  const bool number = node.type == Node::Type::integer || node.type == Node::Type::real;
  if (number && dimension == Dimension::none) {
    return in_range(node.real, range, key, short_number(node.real));
  }
  const auto symbols = units_of(dimension);
  const std::string unit = symbols.empty() ? "" : std::string(symbols.front());
  refuse(key, std::string("is ") + type_name(node) + ", not a " + whirl::name(dimension),
         "write it as \"1 " + unit + "\"");
  return 0.0;
}

double Table::quantity(std::string_view key, Dimension dimension, Range range) const {
  const Node* node = need(key, (std::string("a ") + whirl::name(dimension)).c_str());
  return node == nullptr ? 0.0 : read_quantity(*node, key, dimension, range);
}

double Table::quantity_or(std::string_view key, Dimension dimension, double fallback_SI,
                          Range range) const {
  return has(key) ? quantity(key, dimension, range) : fallback_SI;
}

std::vector<double> Table::quantities(std::string_view key, Dimension dimension,
                                      Range range) const {
  std::vector<double> values;
  const Node* node = need(key, "a list");
  if (node == nullptr) return values;
  if (node->type != Node::Type::table || !node->fields.empty()) {
    refuse(key, std::string("is ") + type_name(*node) + ", not a list", "write it as { a, b, c }");
    return values;
  }
  for (const auto& item : node->list) {
    item->asked = true;
    values.push_back(read_quantity(*item, key, dimension, range));
  }
  return values;
}

std::int64_t Table::duration_ns(std::string_view key) const {
  const double seconds = quantity(key, Dimension::time, between(0.0, 1e9));
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

std::int64_t Table::duration_ns_or(std::string_view key, std::int64_t fallback_ns) const {
  return has(key) ? duration_ns(key) : fallback_ns;
}

double Table::number(std::string_view key, Range range) const {
  return quantity(key, Dimension::none, range);
}

double Table::number_or(std::string_view key, double fallback, Range range) const {
  return has(key) ? number(key, range) : fallback;
}

std::vector<double> Table::numbers(std::string_view key, Range range) const {
  return quantities(key, Dimension::none, range);
}

std::int64_t Table::integer(std::string_view key, std::int64_t low, std::int64_t high) const {
  const Node* node = need(key, "a whole number");
  if (node == nullptr) return 0;
  if (node->type != Node::Type::integer) {
    refuse(key, std::string("is ") + type_name(*node) + ", not a whole number");
    return 0;
  }
  if (node->integer < low || node->integer > high) {
    refuse(key, std::to_string(node->integer) + " is outside " + std::to_string(low) + ".." +
                    std::to_string(high));
    return 0;
  }
  return node->integer;
}

std::int64_t Table::integer_or(std::string_view key, std::int64_t fallback, std::int64_t low,
                               std::int64_t high) const {
  return has(key) ? integer(key, low, high) : fallback;
}

bool Table::flag_or(std::string_view key, bool fallback) const {
  const Node* node = find(key);
  if (node == nullptr) return fallback;
  if (node->type != Node::Type::boolean) {
    refuse(key, std::string("is ") + type_name(*node) + ", not true or false");
    return fallback;
  }
  return node->flag;
}

std::string Table::text(std::string_view key) const {
  const Node* node = need(key, "a text");
  if (node == nullptr) return {};
  if (node->type != Node::Type::text) {
    refuse(key, std::string("is ") + type_name(*node) + ", not a text");
    return {};
  }
  return node->text;
}

std::string Table::text_or(std::string_view key, std::string_view fallback) const {
  return has(key) ? text(key) : std::string(fallback);
}

std::vector<std::string> Table::texts(std::string_view key) const {
  std::vector<std::string> values;
  const Node* node = find(key);
  if (node == nullptr) return values;
  for (const auto& item : node->list) {
    item->asked = true;
    if (item->type == Node::Type::text) values.push_back(item->text);
  }
  if (node->type != Node::Type::table || values.size() != node->list.size() ||
      !node->fields.empty()) {
    refuse(key, "is not a list of texts", "write it as { \"a\", \"b\" }");
  }
  return values;
}

std::string Table::choice(std::string_view key, const std::vector<std::string>& words) const {
  const std::string word = text(key);
  std::string all;
  for (const std::string& candidate : words) {
    if (candidate == word) return word;
    all += (all.empty() ? "" : ", ") + candidate;
  }
  if (has(key)) refuse(key, "'" + word + "' is not known", "use one of " + all);
  return {};
}

Table Table::table(std::string_view key) const {
  static const Node kNothing;
  const Node* node = need(key, "a table");
  if (node == nullptr) return {doc_, &kNothing};
  if (node->type != Node::Type::table) {
    refuse(key, std::string("is ") + type_name(*node) + ", not a table");
    return {doc_, &kNothing};
  }
  return {doc_, node};
}

std::vector<Table> Table::tables(std::string_view key) const {
  return has(key) ? table(key).items() : std::vector<Table>{};
}

std::vector<Table> Table::items() const {
  std::vector<Table> all;
  for (const auto& item : node_->list) {
    item->asked = true;
    if (item->type == Node::Type::table) {
      all.emplace_back(doc_, item.get());
    } else {
      refuse(item->path, std::string("is ") + type_name(*item) + ", not a table");
    }
  }
  return all;
}

Quantity Table::any_quantity(std::string_view key) const {
  const Node* node = need(key, "a quantity");
  if (node == nullptr) return {};
  if (node->type == Node::Type::text) {
    const auto value = parse_quantity(node->text, "");
    if (value) return value.value();
    refuse(key, value.error().what, value.error().cure);
    return {};
  }
  return {read_quantity(*node, key, Dimension::none, kAny), Dimension::none};
}

void Table::refuse(std::string_view key, std::string what, std::string cure) const {
  if (!doc_->first) {
    doc_->first = Error{ErrorKind::bad_input, place(key), std::move(what), std::move(cure)};
  }
}

void Table::ignore(std::string_view key) const {
  find(key);
}

std::string Table::place(std::string_view key) const {
  const std::string path = node_->path.empty() || key == node_->path
                               ? std::string(key)
                               : node_->path + "." + std::string(key);
  if (!doc_->call_place.empty()) return doc_->call_place + ": " + path;
  const int line = line_of(doc_->source, path, !has(key) && key != node_->path);
  return doc_->file + (line == 0 ? "" : ":" + std::to_string(line)) + ": " + path;
}

const std::string& Table::file() const {
  return doc_->file;
}

std::string Table::sibling(std::string_view relative) const {
  return (std::filesystem::path(doc_->file).parent_path() / relative).lexically_normal().string();
}

Result<Done> Table::finish() const {
  return finish_except({});
}

Result<Done> Table::finish_except(const std::vector<std::string>& keys) const {
  if (doc_->first) return *doc_->first;
  const Unknown unknown = unknown_below(doc_->root, keys);
  if (unknown.value == nullptr) return Done{};
  const std::string& path = unknown.value->path;
  const int line = doc_->call_place.empty() ? line_of(doc_->source, path, false) : 0;
  std::string where = doc_->call_place.empty() ? doc_->file : doc_->call_place;
  if (line != 0) where += ":" + std::to_string(line);
  return Error{ErrorKind::bad_input, where, "unknown key '" + path + "'",
               known_keys(*unknown.table)};
}

}  // namespace whirl::lua
