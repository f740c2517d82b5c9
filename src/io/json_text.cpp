#include "io/json_text.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace pirsim::io::detail {
namespace {

constexpr int max_nesting = 100;  // assumed: glTF itself needs about 6; libraries recurse over their JSON
// assumed: a scene of 100,000 nodes has 2 million; in memory a value may take a kilobyte (an empty node in tinygltf)
constexpr std::size_t max_values = 4'000'000;

/// Offset of the quote that closes the string opened at `quote`, or the end of the text.
std::size_t end_of_string(std::string_view text, std::size_t quote) {
  std::size_t at = quote + 1;
  while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
  return std::min(at, text.size());
}

/// Walks over a text that is known to be valid JSON.
class Scanner {
 public:
  Scanner(std::string_view text, std::size_t offset) : text_(text), at_(offset) { skip_space(); }

  [[nodiscard]] std::size_t offset() const noexcept { return at_; }
  [[nodiscard]] char peek() const noexcept { return at_ < text_.size() ? text_[at_] : '\0'; }
  void step_over_punctuation() {
    ++at_;
    skip_space();
  }
  /// The raw characters between the quotes.
  std::string_view take_string() {
    const std::size_t begin = at_ + 1, end = end_of_string(text_, at_);
    at_ = end;
    step_over_punctuation();
    return text_.substr(begin, end - begin);
  }
  void skip_value() {
    int depth = 0;
    do {
      const char c = peek();
      if (c == '"') {
        take_string();
      } else if (c == '{' || c == '[') {
        ++depth;
        step_over_punctuation();
      } else if (c == '}' || c == ']') {
        --depth;
        step_over_punctuation();
      } else if (c == ',' || c == ':') {
        step_over_punctuation();
      } else {
        at_ = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
        skip_space();
      }
    } while (depth > 0 && at_ < text_.size());
  }

 private:
  void skip_space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

  std::string_view text_;
  std::size_t at_;
};

std::string key_of(std::string_view raw) {
  if (raw.find('\\') == std::string_view::npos) return std::string(raw);
  return nlohmann::json::parse('"' + std::string(raw) + '"', nullptr, false).get<std::string>();
}

/// Takes the first token, unescaped (RFC 6901), off a pointer such as `/nodes/4`.
std::string take_token(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const std::size_t end = std::min(pointer.find('/'), pointer.size());
  std::string token;
  for (std::size_t i = 0; i < end; ++i) {
    const bool escape = pointer[i] == '~' && i + 1 < end;
    token += escape ? (pointer[++i] == '1' ? '/' : '~') : pointer[i];
  }
  pointer.remove_prefix(end);
  return token;
}

struct Member {
  std::size_t key = 0;  ///< offset of the key, or of the value in an array
  std::size_t value = 0;
};

/// The last member of that name counts, as it does for the parser.
std::optional<Member> find_member(std::string_view text, std::size_t object, const std::string& name) {
  std::optional<Member> found;
  Scanner scanner(text, object);
  scanner.step_over_punctuation();
  while (scanner.peek() == '"') {
    const std::size_t key_offset = scanner.offset();
    const std::string key = key_of(scanner.take_string());
    scanner.step_over_punctuation();  // :
    if (key == name) found = Member{key_offset, scanner.offset()};
    scanner.skip_value();
    if (scanner.peek() == ',') scanner.step_over_punctuation();
  }
  return found;
}

std::optional<Member> find_element(std::string_view text, std::size_t array, const std::string& name) {
  std::size_t index = 0;
  if (std::from_chars(name.data(), name.data() + name.size(), index).ec != std::errc{}) return std::nullopt;
  Scanner scanner(text, array);
  scanner.step_over_punctuation();
  for (std::size_t i = 0; scanner.peek() != ']' && scanner.peek() != '\0'; ++i) {
    if (i == index) return Member{scanner.offset(), scanner.offset()};
    scanner.skip_value();
    if (scanner.peek() == ',') scanner.step_over_punctuation();
  }
  return std::nullopt;
}

/// Where the token begins that the parser had read up to `last`: a text is complained about at its closing quote.
std::size_t start_of_token(std::string_view text, std::size_t last) {
  if (last >= text.size() || text[last] != '"') return std::min(last, text.size());
  std::size_t begin = last;
  do {
    begin = begin == 0 ? std::string_view::npos : text.rfind('"', begin - 1);
  } while (begin != std::string_view::npos && begin > 0 && text[begin - 1] == '\\');
  return begin == std::string_view::npos ? last : begin;
}

/// nlohmann's message without its prefix and without the text it read last, which may be a whole buffer.
std::string plain_message(std::string message) {
  if (const auto begin = message.find(": syntax error"); begin != std::string::npos) message.erase(0, begin + 2);
  if (const auto last_read = message.find("; last read:"); last_read != std::string::npos) {
    const auto expected = message.find("; expected", last_read);
    message.erase(last_read, expected == std::string::npos ? std::string::npos : expected - last_read);
  }
  return "not valid JSON: " + message;
}

}  // namespace

JsonText::JsonText(std::string file, std::string text, Places places)
    : file_(std::move(file)), text_(std::move(text)), places_(places) {
  if (const auto excess = excess_of_json(text_)) throw Error(ErrorCode::input, at(excess->offset), excess->what);
  try {
    root_ = nlohmann::json::parse(text_);
  } catch (const nlohmann::json::parse_error& fault) {
    throw Error(ErrorCode::input, at(start_of_token(text_, fault.byte == 0 ? 0 : fault.byte - 1)),
                plain_message(fault.what()));
  } catch (const nlohmann::json::out_of_range& fault) {
    const std::string_view message = fault.what();
    const std::size_t begin = message.find('\'') + 1;
    const std::string number(message.substr(begin, message.rfind('\'') - begin));
    throw Error(ErrorCode::input, at(offset_of_number(number)), "number " + number + " is too large");
  }
}

std::optional<JsonExcess> excess_of_json(std::string_view text) {
  int depth = 0;
  std::size_t values = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      i = end_of_string(text, i);
    } else if (c == '{' || c == '[') {
      ++values;
      if (++depth > max_nesting) return {{i, "JSON nested deeper than " + std::to_string(max_nesting) + " levels"}};
    } else if (c == '}' || c == ']') {
      --depth;
    } else if (c == ',') {
      ++values;
    }
    if (values > max_values) return {{i, "JSON of more than " + std::to_string(max_values) + " values"}};
  }
  return std::nullopt;
}

std::size_t JsonText::offset_of_number(std::string_view number) const {
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '"') {
      i = end_of_string(text_, i);
    } else if (text_.compare(i, number.size(), number) == 0) {
      return i;
    }
  }
  return 0;
}

Where JsonText::where(std::string_view pointer) const { return find(pointer, Target::value); }
Where JsonText::where_key(std::string_view pointer) const { return find(pointer, Target::key); }

Where JsonText::find(std::string_view pointer, Target target) const {
  if (places_ == Places::unknown) return {file_, 0, 0};
  Member member;
  member.key = member.value = Scanner(text_, 0).offset();
  while (!pointer.empty()) {
    const std::string token = take_token(pointer);
    std::optional<Member> next;
    if (text_[member.value] == '{') next = find_member(text_, member.value, token);
    if (text_[member.value] == '[') next = find_element(text_, member.value, token);
    if (!next) return at(member.value);
    member = *next;
  }
  return at(target == Target::key ? member.key : member.value);
}

Where JsonText::at(std::size_t offset) const {
  if (places_ == Places::unknown) return {file_, 0, 0};
  offset = std::min(offset, text_.size());
  const std::string_view before = std::string_view(text_).substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::string_view on_line = before.substr(before.rfind('\n') + 1);                             // npos + 1 is 0
  const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };  // UTF-8
  const auto column = 1 + std::count_if(on_line.begin(), on_line.end(), is_character);
  return {file_, static_cast<int>(line), static_cast<int>(column)};
}

}  // namespace pirsim::io::detail
