#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "arris/error.h"
#include "io/toml_document.h"

namespace arris {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// The value as text that shows its structure.
std::string show(const TomlValue& value);
std::string show(const TomlTable& table) {
  std::string text = "{";
  for (const TomlMember& member : table) text += member.key + "=" + show(member.value) + ";";
  return text + "}";
}
std::string show(const TomlValue& value) {
  if (const auto* table = std::get_if<TomlTable>(&value.data)) return show(*table);
  if (const auto* text = std::get_if<std::string>(&value.data)) {
    std::string quoted(1, '\'');
    return quoted.append(*text).append(1, '\'');
  }
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return std::to_string(*integer);
  if (const auto* flag = std::get_if<bool>(&value.data))
    return std::string(*flag ? "true" : "false");
  if (const auto* number = std::get_if<double>(&value.data))
    return std::string("f").append(std::to_string(*number));
  if (std::holds_alternative<TomlDate>(value.data)) return "date";
  std::string text = "[";
  for (const TomlValue& element : std::get<TomlArray>(value.data)) text += show(element) + ",";
  return text + "]";
}

std::string shown(const std::string& text) {
  return show(parse_toml(text, "t.toml"));
}

std::string refusal(const std::string& text) {
  try {
    parse_toml(text, "t.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "(was read)";
}

TEST(TomlParse, reads_numbers) {
  EXPECT_EQ(shown("a = [0, -0, +7, 1_000, 0xDEAD_beef, 0o17, 0b101]"),
            "{a=[0,0,7,1000,3735928559,15,5,];}");
  EXPECT_EQ(shown("a = [1.5, -0.25, 1e3, 1E-2, 6.5e+1, 1_0.2_5]"),
            "{a=[f1.500000,f-0.250000,f1000.000000,f0.010000,f65.000000,f10.250000,];}");
  EXPECT_EQ(shown("a = [inf, -inf, +inf]"), "{a=[finf,f-inf,finf,];}");
  EXPECT_EQ(shown("a = 9223372036854775807"), "{a=9223372036854775807;}");
  const TomlTable nan = parse_toml("a = -nan", "t");
  EXPECT_TRUE(std::isnan(std::get<double>(nan[0].value.data)));
}

TEST(TomlParse, refuses_what_is_no_number) {
  for (const char* text : {"01",    "1_",   "_1",   "1__0", "1.",   ".5",  "1e",
                           "0x",    "-0x1", "0x-1", "0b2",  "1.e5", "+-1", "9223372036854775808",
                           "1e999", "0o8",  "1_.5", "++1",  "yes",  "-",   "1-2"}) {
    EXPECT_THAT(refusal("a = " + std::string(text)), StartsWith("t.toml:1:5: ")) << text;
  }
}

TEST(TomlParse, reads_strings) {
  EXPECT_EQ(shown(R"(a = "q\"b\\t\tn\u00e9\U0001F600")"), "{a='q\"b\\t\tn\u00e9\U0001F600';}");
  EXPECT_EQ(shown(R"(a = 'C:\new')"), "{a='C:\\new';}");
  EXPECT_EQ(shown("a = \"\"\"\nfirst\nsecond\"\"\""), "{a='first\nsecond';}");
  EXPECT_EQ(shown("a = \"\"\"one \\\n   \n  two\"\"\""), "{a='one two';}");
  EXPECT_EQ(shown("a = '''it''s'''''"), "{a='it''s''';}");
  EXPECT_EQ(shown("a = \"\""), "{a='';}");
  EXPECT_EQ(shown("a = \"\"\"\r\nx\r\ny\"\"\"\r\nb = 1\r\n"), "{a='x\ny';b=1;}");
}

TEST(TomlParse, refuses_broken_strings) {
  for (const char* text :
       {"\"abc", "'abc", "\"\"\"abc\"\"", "\"a\nb\"", "\"\\x\"", "\"\\u12G4\"", "\"\\uD800\"",
        "\"\\U00110000\"", "\"\\u12\"", "\"\x01\"", "'\x7F'", "\"a\\\nb\"x", "\"\\"}) {
    EXPECT_THAT(refusal("a = " + std::string(text)), StartsWith("t.toml:")) << text;
  }
}

TEST(TomlParse, reads_tables_dotted_keys_and_arrays_of_tables) {
  EXPECT_EQ(shown("[a.b]\nx = 1\n[a]\ny = 2\n"), "{a={b={x=1;};y=2;};}");
  EXPECT_EQ(shown("a.b.c = 1\na.b.d = 2\n"), "{a={b={c=1;d=2;};};}");
  EXPECT_EQ(shown("[[a]]\nx = 1\n[[a]]\n[a.b]\ny = 2\n[[a.c]]\n"),
            "{a=[{x=1;},{b={y=2;};c=[{},];},];}");
  EXPECT_EQ(shown("a = { b.c = 1, b.d = [ ], e = {} }"), "{a={b={c=1;d=[];};e={};};}");
  EXPECT_EQ(shown("\"a b\".'c' = 1"), "{a b={c=1;};}");
  EXPECT_EQ(shown("a = [ # one\n 1, # two\n\n 2,\n]\n# end"), "{a=[1,2,];}");
  EXPECT_EQ(shown("a = true # yes"), "{a=true;}");
  EXPECT_EQ(shown("a = 1979-05-27 07:32:00.5Z"), "{a=date;}");
  EXPECT_EQ(shown("1234 = 07:32:00"), "{1234=date;}");
  EXPECT_EQ(shown(""), "{}");
}

TEST(TomlParse, refuses_to_define_a_thing_twice) {
  for (const char* text :
       {"a = 1\na = 2", "[a]\n[a]", "a = 1\n[a]", "[a]\n[[a]]", "[[a]]\n[a]", "a.b = 1\n[a]",
        "[a.b]\n[a]\nb.c = 1", "a = {}\n[a.b]", "a = {}\na.b = 1", "a = []\n[[a]]",
        "a = { b = 1, b = 2 }", "a = { b = {}, b.c = 1 }", "[a]\nb = 1\n[a.b]"}) {
    EXPECT_THAT(refusal(text), HasSubstr("already defined")) << text;
  }
}

TEST(TomlParse, refuses_broken_structure) {
  for (const char* text : {"a",
                           "a =",
                           "= 1",
                           "a = 1 b = 2",
                           "[a",
                           "[]",
                           "[a]]",
                           "[[a]",
                           "a = [1 2]",
                           "a = [1,,2]",
                           "a = { b = 1",
                           "a = { b = 1, }",
                           "a = {\nb = 1 }",
                           "a..b = 1",
                           ".a = 1",
                           "a = 1\rb = 2",
                           "\"\"\"a\"\"\" = 1",
                           "[ [a] ]",
                           "a = ]",
                           "{",
                           "\xC3\xA4 = 1",
                           "a = 1 \xC2\xA0"}) {
    EXPECT_THAT(refusal(text), StartsWith("t.toml:")) << text;
  }
}

TEST(TomlParse, says_where_values_and_keys_are) {
  const TomlTable table = parse_toml("# one\n[a]\n  key  =  [1,\n   2]\n", "t.toml");
  const auto& a = std::get<TomlTable>(table.at(0).value.data);
  EXPECT_EQ(table[0].value.place.line, 2U);
  EXPECT_EQ(a.at(0).place.line, 3U);
  EXPECT_EQ(a[0].place.column, 3U);
  EXPECT_EQ(a[0].value.place.column, 11U);
  const TomlPlace two = std::get<TomlArray>(a[0].value.data).at(1).place;
  EXPECT_EQ(two.line, 4U);
  EXPECT_EQ(two.column, 4U);
}

TEST(TomlParse, bounds_nesting) {
  EXPECT_THAT(refusal("a = " + std::string(100000, '[')), HasSubstr("nested more than 32 deep"));
  std::string nested = "a = ";
  for (int i = 0; i < 100000; ++i) nested += "{a=";
  EXPECT_THAT(refusal(nested), HasSubstr("nested more than 32 deep"));
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i) dotted += ".a";
  EXPECT_THAT(refusal(dotted + " = 1"), HasSubstr("more than 8 parts"));
  EXPECT_THAT(refusal("[" + dotted + "]"), HasSubstr("more than 8 parts"));
}

}  // namespace
}  // namespace arris
