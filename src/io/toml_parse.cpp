// toml_parse.cpp — tables, arrays and their values
// Source     TOML v1.0.0 (2021): which tables may be defined twice is its section "Table"
#include <fmt/format.h>

#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/toml_document.h"
#include "io/toml_scanner.h"

namespace arris {
namespace {

// No scene needs more; they bound the recursion of parsing and of destructors.
constexpr int kMaxDepth = 32;
constexpr std::size_t kMaxKeyParts = 8;

// A value while the file is being read: tables may still grow.
struct Node {
  enum class Kind {
    implicit,  // a table that only longer headers have named: [a.b] makes a
    header,    // [a]
    dotted,    // a.b = 1 makes a
    tables,    // [[a]]
    value,     // also arrays and inline tables: complete
  };
  Kind kind = Kind::value;
  TomlPlace key_place;
  TomlValue value;
  std::map<std::string, std::size_t, std::less<>> index;  // into members
  std::vector<std::pair<std::string, std::unique_ptr<Node>>> members;
  std::vector<std::unique_ptr<Node>> elements;  // of kind tables

  Node* find(const std::string& key) {
    const auto found = index.find(key);
    return found == index.end() ? nullptr : members[found->second].second.get();
  }
  Node& add(const std::string& key, Kind new_kind, TomlPlace place) {
    index.emplace(key, members.size());
    auto& node = members.emplace_back(key, std::make_unique<Node>()).second;
    node->kind = new_kind;
    node->key_place = node->value.place = place;
    return *node;
  }
};

TomlValue finish(Node& node) {
  if (node.kind == Node::Kind::tables) {
    TomlArray array;
    for (const auto& element : node.elements) array.push_back(finish(*element));
    node.value.data = std::move(array);
  } else if (node.kind != Node::Kind::value) {
    TomlTable table;
    table.reserve(node.members.size());
    for (auto& [key, member] : node.members) {
      const TomlPlace place = member->key_place;
      table.push_back({std::move(key), place, finish(*member)});
    }
    node.value.data = std::move(table);
  }
  return std::move(node.value);
}

struct KeyPart {
  std::string text;
  TomlPlace place;
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& where) : scanner_(text, where) {
    root_.kind = Node::Kind::header;
  }

  TomlTable parse() {
    Node* table = &root_;
    for (scanner_.skip_blanks_and_lines(); !scanner_.at_end(); scanner_.skip_blanks_and_lines()) {
      if (scanner_.peek() == '[') {
        table = &parse_header();
      } else {
        parse_member(*table);
      }
      scanner_.end_line();
    }
    return std::get<TomlTable>(finish(root_).data);
  }

 private:
  std::vector<KeyPart> parse_key() {
    std::vector<KeyPart> key;
    do {
      scanner_.skip_blanks();
      const TomlPlace place = scanner_.place();
      if (key.size() == kMaxKeyParts) {
        scanner_.fail(fmt::format("a key of more than {} parts", kMaxKeyParts));
      }
      key.push_back({scanner_.scan_key_part(), place});
      scanner_.skip_blanks();
    } while (scanner_.skip("."));
    return key;
  }

  [[noreturn]] void fail_defined(const KeyPart& part) {
    scanner_.fail_at(part.place, in_quotes(part.text) + " is already defined above");
  }

  // [a.b] and [[a.b]]
  Node& parse_header() {
    const TomlPlace place = scanner_.place();
    const bool is_array = scanner_.skip("[[");
    if (!is_array) scanner_.expect("[", "[");
    const std::vector<KeyPart> key = parse_key();
    scanner_.expect(is_array ? "]]" : "]", is_array ? "]]" : "]");
    Node* table = &root_;
    for (std::size_t i = 0; i + 1 < key.size(); ++i) table = &enter(*table, key[i]);
    Node& node = is_array ? append_element(*table, key.back()) : define(*table, key.back());
    node.value.place = place;
    return node;
  }

  // The table that a part of a header but its last names.
  Node& enter(Node& table, const KeyPart& part) {
    Node* found = table.find(part.text);
    if (found == nullptr) return table.add(part.text, Node::Kind::implicit, part.place);
    if (found->kind == Node::Kind::value) fail_defined(part);
    return found->kind == Node::Kind::tables ? *found->elements.back() : *found;
  }

  Node& define(Node& table, const KeyPart& part) {
    Node* found = table.find(part.text);
    if (found == nullptr) return table.add(part.text, Node::Kind::header, part.place);
    if (found->kind != Node::Kind::implicit) fail_defined(part);
    found->kind = Node::Kind::header;
    found->key_place = part.place;
    return *found;
  }

  Node& append_element(Node& table, const KeyPart& part) {
    Node* found = table.find(part.text);
    if (found == nullptr) found = &table.add(part.text, Node::Kind::tables, part.place);
    if (found->kind != Node::Kind::tables) fail_defined(part);
    Node& element = *found->elements.emplace_back(std::make_unique<Node>());
    element.kind = Node::Kind::header;
    return element;
  }

  // a.b = value
  void parse_member(Node& table) {
    const std::vector<KeyPart> key = parse_key();
    scanner_.expect("=", "= and a value");
    scanner_.skip_blanks();
    Node* owner = &table;
    for (std::size_t i = 0; i + 1 < key.size(); ++i) {
      Node* found = owner->find(key[i].text);
      if (found == nullptr) found = &owner->add(key[i].text, Node::Kind::dotted, key[i].place);
      if (found->kind != Node::Kind::dotted) fail_defined(key[i]);
      owner = found;
    }
    if (owner->find(key.back().text) != nullptr) fail_defined(key.back());
    TomlValue value = parse_value();
    owner->add(key.back().text, Node::Kind::value, key.back().place).value = std::move(value);
  }

  TomlValue parse_value() {
    const char c = scanner_.peek();
    if (c != '[' && c != '{') return scanner_.scan_scalar();
    if (++depth_ > kMaxDepth) scanner_.fail(fmt::format("nested more than {} deep", kMaxDepth));
    TomlValue value = c == '[' ? parse_array() : parse_inline_table();
    --depth_;
    return value;
  }

  TomlValue parse_array() {
    TomlValue value;
    value.place = scanner_.place();
    TomlArray elements;
    scanner_.expect("[", "[");
    for (scanner_.skip_blanks_and_lines(); !scanner_.skip("]");) {
      elements.push_back(parse_value());
      scanner_.skip_blanks_and_lines();
      if (scanner_.peek() != ']') scanner_.expect(",", "a comma or ]");
      scanner_.skip_blanks_and_lines();
    }
    value.data = std::move(elements);
    return value;
  }

  TomlValue parse_inline_table() {
    Node table;
    table.kind = Node::Kind::header;
    table.value.place = scanner_.place();
    scanner_.expect("{", "{");
    scanner_.skip_blanks();
    if (scanner_.skip("}")) return finish(table);
    do {
      scanner_.skip_blanks();
      parse_member(table);
      scanner_.skip_blanks();
    } while (scanner_.skip(","));
    scanner_.expect("}", "a comma or }");
    return finish(table);
  }

  TomlScanner scanner_;
  Node root_;
  int depth_ = 0;
};

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

TomlTable parse_toml(std::string_view text, const std::string& where) {
  if (!is_utf8(text)) {
    throw Error(Error::Kind::input, where, "is not UTF-8 text; save it as UTF-8");
  }
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return Parser(text, where).parse();
}

}  // namespace arris
