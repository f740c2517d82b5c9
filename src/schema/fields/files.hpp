// Fields of places in files, and of messages about them (schema/fields.hpp).
#pragma once

#include <tuple>

#include "pirsim/error.hpp"
#include "pirsim/input_file.hpp"
#include "schema/field.hpp"
#include "schema/fields/accepted.hpp"
#include "schema/words.hpp"

namespace pirsim {

template <>
struct Fields<Where> {
  using S = Where;
  static constexpr const char* name = "Where";
  static constexpr const char* about = "A place in a file, for messages; line and column count from 1.";
  static constexpr std::tuple all{LABEL(file), LABEL(line), LABEL(column)};
};

template <>
struct Fields<InputFile> {
  using S = InputFile;
  static constexpr const char* name = "InputFile";
  static constexpr const char* about = "A file that was read, and the SHA-256 of the bytes that it had then.";
  static constexpr std::tuple all{LABEL(path), LABEL(sha256)};
};

template <>
struct Fields<Issue> {
  using S = Issue;
  static constexpr const char* name = "Diagnostic";
  static constexpr const char* about = "One fault or remark.";
  static constexpr std::tuple all{LABEL(severity), LABEL(where), LABEL(message)};
};

}  // namespace pirsim
