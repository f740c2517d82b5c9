#include "model/core/text.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "support/catch.hpp"

using namespace pirsim;

TEST_CASE("UTF-8 is what the Unicode standard's table 3-7 lets through") {
  for (const std::string_view good :
       {"", "abc", "caf\xC3\xA9", "\xE2\x82\xAC", "\xED\x9F\xBF", "\xF0\x9F\x98\x80", "\xF4\x8F\xBF\xBF"})
    CHECK_FALSE(first_not_utf8(good).has_value());
  struct Bad {
    std::string_view text;
    std::size_t at;
  };
  for (const Bad& bad : std::vector<Bad>{{"ab\x80", 2},            // nothing to continue
                                         {"caf\xE9", 3},           // Latin-1
                                         {"\xC0\xAF", 0},          // overlong
                                         {"\xE0\x9F\xBF", 0},      // overlong
                                         {"\xF0\x8F\xBF\xBF", 0},  // overlong
                                         {"x\xED\xA0\x80", 1},     // a surrogate
                                         {"\xF4\x90\x80\x80", 0},  // beyond U+10FFFF
                                         {"a\xE2\x82", 1},         // cut short
                                         {"\xFF", 0}}) {
    CHECK(first_not_utf8(bad.text) == bad.at);
  }
}

TEST_CASE("characters that nobody sees for what they are") {
  for (const std::string_view plain : {"", "S1", "Küche 2", "会議室", "a 'b' \"c\" <d>"})
    CHECK(invisible_character(plain, Lines::one).empty());
  CHECK(invisible_character("a\nb\tc", Lines::many).empty());
  CHECK(invisible_character("a\nb", Lines::one) == "the control character U+000A");
  CHECK(invisible_character(std::string_view("a\0b", 3), Lines::many) == "the control character U+0000");
  CHECK(invisible_character("\x1B[2J", Lines::many) == "the control character U+001B");
  CHECK(invisible_character("\x7F", Lines::many) == "the control character U+007F");
  CHECK(invisible_character("\xC2\x85", Lines::many) == "the control character U+0085");
  for (const std::string_view mark :
       {"\xD8\x9C", "\xE2\x80\x8E", "\xE2\x80\x8F", "\xE2\x80\xA8", "\xE2\x80\xAE", "\xE2\x81\xA6", "\xE2\x81\xA9"})
    CHECK(invisible_character(mark, Lines::many).starts_with("U+"));
}

TEST_CASE("messages shorten what they quote, and nothing else") {
  const std::string name(1000, 'n'), shown = std::string(100, 'n') + "...";
  CHECK(tellable("node '" + name + "' isn't here, and neither is '" + name + "'; there's 'x'") ==
        "node '" + shown + "' isn't here, and neither is '" + shown + "'; there's 'x'");
  CHECK(tellable("it isn't, and doesn't " + name) == "it isn't, and doesn't " + name);
  CHECK(tellable("'" + name).size() == name.size() + 1);
  CHECK(tellable(std::string(1'000'000, 'm')).size() < 30'000);
  std::string wide;
  for (int i = 0; i < 200; ++i) wide += "\xE2\x82\xAC";
  CHECK_FALSE(first_not_utf8(shortened(wide)).has_value());
  CHECK(shortened("S1") == "S1");
}

TEST_CASE("messages contain nothing that a terminal would obey") {
  CHECK(tellable(std::string_view("a\0b\x1B[2J\nc\xFF\xE2\x80\xAE", 13)) == "a?b?[2J\nc??");
}

TEST_CASE("names in Markdown are shown as they are") {
  CHECK(markdown_text("a|b <i> [x](y) `z` *k* _u_\nnext") == "a\\|b \\<i\\> \\[x\\](y) \\`z\\` \\*k\\* \\_u\\_ next");
  CHECK(markdown_code("plain.gltf") == "`plain.gltf`");
  CHECK(markdown_code("a`b``c") == "``` a`b``c ```");
}

TEST_CASE("of many names that there are, twenty are told") {
  std::vector<std::string> known;
  for (char name = 'a'; name <= 'v'; ++name) known.push_back(std::string(8, name));
  const std::string told = near_or_all("1", known);
  CHECK_THAT(told, contains("aaaaaaaa, bbbbbbbb") && contains("tttttttt and 2 more"));
  CHECK_THAT(told, !contains("uuuuuuuu"));
  CHECK_THAT(near_or_all("1", {known.begin(), known.begin() + 20}), !contains("more"));
}
