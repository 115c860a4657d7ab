#include "io/toml_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "arris/error.h"

namespace arris {
namespace {

// Without places; whole numbers may be read as integers.
bool is_same(const TomlValue& a, const TomlValue& b);

bool is_same(const TomlTable& a, const TomlTable& b) {
  if (a.size() != b.size()) return false;
  for (const TomlMember& member : a) {
    const auto other = std::ranges::find(b, member.key, &TomlMember::key);
    if (other == b.end() || !is_same(member.value, other->value)) return false;
  }
  return true;
}

std::optional<double> number_in(const TomlValue& value) {
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  const auto* whole = std::get_if<std::int64_t>(&value.data);
  return whole == nullptr ? std::nullopt : std::optional(double(*whole));
}

bool is_same(const TomlValue& a, const TomlValue& b) {
  if (const auto number = number_in(a)) {
    return number == number_in(b) || (std::isnan(*number) && std::isnan(number_in(b).value_or(0)));
  }
  if (a.data.index() != b.data.index()) return false;
  if (const auto* table = std::get_if<TomlTable>(&a.data)) {
    return is_same(*table, std::get<TomlTable>(b.data));
  }
  if (const auto* array = std::get_if<TomlArray>(&a.data)) {
    return std::ranges::equal(*array, std::get<TomlArray>(b.data),
                              [](const TomlValue& x, const TomlValue& y) { return is_same(x, y); });
  }
  if (const auto* text = std::get_if<std::string>(&a.data)) {
    return *text == std::get<std::string>(b.data);
  }
  return std::get<bool>(a.data) == std::get<bool>(b.data);
}

class RandomTree {
 public:
  explicit RandomTree(unsigned seed) : random_(seed) {}

  TomlTable table(int depth) {
    TomlTable out;
    for (std::size_t i = pick(5); i-- > 0;) set_toml(out, text(), value(depth));
    return out;
  }

 private:
  std::size_t pick(std::size_t count) { return random_() % count; }
  std::string text() {
    static const std::vector<std::string> kPieces = {
        "a",      "B",      "-", "_",    "7",    ".",        " ",
        "\"",     "\\",     "'", "\n",   "\r\n", "\t",       "#",
        "[",      "]",      "=", "\x01", "\x7f", "\xC3\xBC", "\xF0\x9F\x94\xBA",
        "\"\"\"", "\\u0041"};
    std::string out;
    for (std::size_t i = pick(4); i-- > 0;) out += kPieces[pick(kPieces.size())];
    return out;
  }
  TomlData value(int depth) {
    const double numbers[] = {0.1,
                              -3,
                              1e300,
                              5e-324,
                              std::numeric_limits<double>::infinity(),
                              std::nan(""),
                              std::ldexp(double(random_()), int(pick(200)) - 100)};
    switch (pick(depth > 0 ? 7 : 4)) {
      case 0:
        return text();
      case 1:
        return numbers[pick(std::size(numbers))];
      case 2:
        return std::int64_t(random_()) << pick(32);
      case 3:
        return pick(2) == 0;
      case 4:
        return table(depth - 1);
      case 5: {
        TomlArray tables;
        for (std::size_t i = pick(4); i-- > 0;) tables.push_back({{}, table(depth - 1)});
        return tables;
      }
      default: {
        TomlArray mixed;
        for (std::size_t i = pick(4); i-- > 0;) mixed.push_back({{}, value(depth - 1)});
        return mixed;
      }
    }
  }

  std::mt19937 random_;
};

TEST(TomlWriter, any_tree_is_read_back) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const TomlTable tree = RandomTree(seed).table(5);
    const std::string text = write_toml(tree);
    try {
      ASSERT_TRUE(is_same(tree, parse_toml(text, "t"))) << text;
    } catch (const Error& error) {
      FAIL() << error.what() << "\n" << text;
    }
  }
}

TEST(TomlWriter, writes_tables_as_people_do) {
  const std::string text =
      "up = [0, 0, 1]\n\n[camera]\nfov = 30\n\n[[camera.key]]\nframe = 1.5\n\n[material.\"a b\"]\n"
      "roughness = 0.1\nbase_color_texture = { file = \"x.png\" }\n\n[[object]]\nshape = \"box\"\n"
      "round = { radius = 1 }\n\n[[object.part]]\nnumber = 1\n\n[[object.part]]\nnumber = 2\n\n"
      "[[object]]\nshape = \"cone\"\n";
  EXPECT_EQ(write_toml(parse_toml(text, "t")), text);
}

TEST(TomlWriter, changes_members_by_key) {
  TomlTable table = parse_toml("a = 1\nb.c = 2\n", "t");
  set_toml(table, "a", std::string("x"));
  set_toml(table, "d", true);
  erase_toml(table, {"b", "nothing"});
  EXPECT_EQ(write_toml(table), "a = \"x\"\nd = true\n");
  EXPECT_EQ(find_toml(table, "b"), nullptr);
}

}  // namespace
}  // namespace arris
