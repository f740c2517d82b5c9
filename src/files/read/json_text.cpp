#include "files/read/json_text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <nlohmann/json.hpp>
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

/// The last member of that name counts, as it does for the parser.
template <typename Members>
auto named(const Members& members, const std::string& name) {
  const auto found = std::find_if(members.rbegin(), members.rend(), [&](const auto& m) { return m.name == name; });
  return found == members.rend() ? std::nullopt : std::optional(*found);
}

template <typename Members>
auto numbered(const Members& members, const std::string& number) {
  std::size_t index = members.size();
  std::from_chars(number.data(), number.data() + number.size(), index);
  return index < members.size() ? std::optional(members[index]) : std::nullopt;
}

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Where the token begins that the parser had read up to `last`: a text is complained about at its closing quote, a
/// word at the first letter that doesn't fit, as the y of `type` where `true` might have stood.
std::size_t start_of_token(std::string_view text, std::size_t last) {
  if (last >= text.size()) return text.size();
  if (text[last] != '"') {
    while (last > 0 && is_of_word(text[last]) && is_of_word(text[last - 1])) --last;
    return last;
  }
  std::size_t begin = last;
  do {
    begin = begin == 0 ? std::string_view::npos : text.rfind('"', begin - 1);
  } while (begin != std::string_view::npos && begin > 0 && text[begin - 1] == '\\');
  return begin == std::string_view::npos ? last : begin;
}

/// The token at an offset as messages tell it: cut, since it may be a whole buffer, and fit for a terminal.
std::string token_told(std::string_view text, std::size_t offset) {
  constexpr std::size_t longest = 40;
  const std::size_t end = text[offset] == '"' ? end_of_string(text, offset) + 1
                                              : std::max(offset + 1, text.find_first_of(",:]} \t\r\n", offset));
  std::string token(text.substr(offset, std::min(end, text.size()) - offset));
  if (token.size() > longest) token = token.substr(0, longest) + "...";
  std::ranges::replace_if(
      token, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return token;
}

/// Keeps what the parser says of the first fault, and nothing else.
class FaultFinder : public nlohmann::detail::json_sax_acceptor<nlohmann::json> {
 public:
  explicit FaultFinder(std::string_view text) : text_(text) {}
  [[nodiscard]] JsonFault fault() && { return std::move(fault_); }

  /// `n_read`: bytes up to the end of the token.
  bool parse_error(std::size_t n_read, const std::string& token, const nlohmann::detail::exception& fault) {
    constexpr int number_too_large = 406;  // the library's documented id
    if (fault.id == number_too_large) {
      fault_.offset = n_read - std::min(n_read, token.size());
      fault_.message = "number " + token_told(text_, fault_.offset) + " is too large";
    } else {
      fault_.offset = start_of_token(text_, n_read == 0 ? 0 : n_read - 1);
      const bool at_end = fault_.offset >= text_.size();
      fault_.message =
          "not valid JSON: " + (at_end ? "it ends too early" : "unexpected " + token_told(text_, fault_.offset));
    }
    return false;
  }

 private:
  std::string_view text_;
  JsonFault fault_;
};

/// Too many levels or values, if there are. Looked for before parsing.
std::optional<JsonFault> excess_of_json(std::string_view text) {
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

}  // namespace

std::variant<nlohmann::json, JsonFault> parse_json(std::string_view text) {
  if (auto excess = excess_of_json(text)) return *std::move(excess);
  nlohmann::json root = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_discarded()) return root;
  FaultFinder finder(text);
  nlohmann::json::sax_parse(text, &finder);
  return std::move(finder).fault();
}

JsonText::JsonText(std::string file, std::string text, Places places)
    : file_(std::move(file)), text_(std::move(text)), places_(places) {
  auto parsed = parse_json(text_);
  if (const auto* fault = std::get_if<JsonFault>(&parsed)) {
    throw Error(ErrorCode::input, at(fault->offset), fault->message);
  }
  root_ = std::make_shared<const nlohmann::json>(std::get<nlohmann::json>(std::move(parsed)));
}

Where JsonText::where(std::string_view pointer) const { return find(pointer, Target::value); }
Where JsonText::where_key(std::string_view pointer) const { return find(pointer, Target::key); }

JsonText::Members JsonText::members_of(std::string_view text, std::size_t offset) {
  Members members;
  Scanner scanner(text, offset);
  const bool is_object = scanner.peek() == '{';
  scanner.step_over_punctuation();
  while (scanner.peek() != ']' && scanner.peek() != '}' && scanner.peek() != '\0') {
    Member& member = members.emplace_back();
    member.key = scanner.offset();
    if (is_object) {
      member.name = key_of(scanner.take_string());
      scanner.step_over_punctuation();  // :
    }
    member.value = scanner.offset();
    scanner.skip_value();
    if (scanner.peek() == ',') scanner.step_over_punctuation();
  }
  return members;
}

std::optional<JsonText::Member> JsonText::member_of(std::size_t offset, const std::string& name) const {
  const char opens = text_[offset];
  if (opens != '{' && opens != '[') return std::nullopt;
  const auto look = [&](const Members& members) {
    return opens == '{' ? named(members, name) : numbered(members, name);
  };
  if (const auto noted = noted_.find(offset); noted != noted_.end()) return look(noted->second);
  constexpr std::size_t long_enough = 4096;  // bytes: less is scanned faster than looked up
  Members members = members_of(text_, offset);
  if (members.empty() || members.back().value - offset < long_enough) return look(members);
  return look(noted_.emplace(offset, std::move(members)).first->second);
}

Where JsonText::find(std::string_view pointer, Target target) const {
  if (places_ == Places::unknown) return {file_, 0, 0};
  Member member;
  member.key = member.value = Scanner(text_, 0).offset();
  while (!pointer.empty()) {
    std::optional<Member> next = member_of(member.value, take_token(pointer));
    if (!next) return at(member.value);
    member = *std::move(next);
  }
  return at(target == Target::key ? member.key : member.value);
}

void JsonText::count(std::size_t from, std::size_t to, LineAndColumn& place) const {
  for (std::size_t i = from; i < to; ++i) {
    const auto c = static_cast<unsigned char>(text_[i]);
    if (c == '\n') {
      ++place.line;
      place.column = 1;
    } else if ((c & 0xC0U) != 0x80U) {  // a character of UTF-8 begins
      ++place.column;
    }
  }
}

Where JsonText::at(std::size_t offset) const {
  if (places_ == Places::unknown) return {file_, 0, 0};
  offset = std::min(offset, text_.size());
  constexpr std::size_t every = 4096;
  if (counted_.empty()) counted_.emplace_back();
  for (std::size_t n = counted_.size(); n <= offset / every; ++n) {
    LineAndColumn next = counted_.back();
    count((n - 1) * every, n * every, next);
    counted_.push_back(next);
  }
  LineAndColumn place = counted_[offset / every];
  count(offset / every * every, offset, place);
  return {file_, static_cast<int>(place.line), static_cast<int>(place.column)};
}

}  // namespace pirsim::io::detail
