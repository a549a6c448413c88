#include <charconv>

#include "base/text.hpp"
#include "harness/lua/node.hpp"
#include "harness/lua/table.hpp"

namespace whirl::lua {
namespace {

bool read_hexadecimal(const std::string& value, std::int64_t& into) {
  if (!value.starts_with("0x") || value.size() < 3) return false;
  const char* last = value.data() + value.size();
  const auto [end, status] = std::from_chars(value.data() + 2, last, into, 16);
  return status == std::errc() && end == last;
}

void assign(Node& node, const std::string& value) {
  node.fields.clear();
  node.list.clear();
  if (read_hexadecimal(value, node.integer)) {
    node.type = Node::Type::integer;
    node.real = static_cast<double>(node.integer);
    return;
  }
  const auto [end, status] = std::from_chars(value.data(), value.data() + value.size(), node.real);
  if (value == "true" || value == "false") {
    node.type = Node::Type::boolean;
    node.flag = value == "true";
  } else if (status == std::errc() && end == value.data() + value.size()) {
    const auto whole = std::from_chars(value.data(), value.data() + value.size(), node.integer);
    const bool is_whole = whole.ec == std::errc() && whole.ptr == end;
    node.type = is_whole ? Node::Type::integer : Node::Type::real;
  } else {
    node.type = Node::Type::text;
    node.text = value;
  }
}

// The element or field of that name, made where it is a new field; null: no such element.
Node* child(Node& node, std::string_view name) {
  std::size_t number = 0;
  const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (status == std::errc() && end == name.data() + name.size()) {
    return number >= 1 && number <= node.list.size() ? node.list[number - 1].get() : nullptr;
  }
  auto& field = node.fields[std::string(name)];
  if (!field) {
    field = std::make_unique<Node>();
    field->path = (node.path.empty() ? "" : node.path + ".") + std::string(name);
  }
  return field.get();
}

}  // namespace

Result<Done> Table::put(std::string_view path, const std::string& value) {
  // The document is the caller's own: a table is a view of it that may be written through.
  Node* node = path.ends_with('.') ? nullptr : &doc_->root;
  for (std::string_view rest = path; !rest.empty() && node != nullptr;) {
    const auto dot = rest.find('.');
    const std::string_view name = rest.substr(0, dot);
    rest = dot == std::string_view::npos ? std::string_view{} : rest.substr(dot + 1);
    const bool is_table = node->type == Node::Type::table;
    node = is_table && !name.empty() ? child(*node, name) : nullptr;
  }
  if (node == nullptr) {
    return Error{ErrorKind::bad_input, "",
                 "--set: '" + std::string(path) + "' leads to nothing that can be set in " + file(),
                 "a part of it is no table there, or a list has no such element"};
  }
  assign(*node, legal_text(value));
  return Done{};
}

}  // namespace whirl::lua
