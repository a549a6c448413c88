// Result<T>: a value, or one clear sentence about what the user gave us.
//
//   An Error says what kind it is (which fixes the exit code), where (file:line, register, option),
//   what is wrong and, where there is one, the cure.
#pragma once
#include <string>
#include <utility>
#include <variant>

#include "base/check.hpp"

namespace whirl {

enum class ErrorKind {
  bad_input,  // plan, vehicle, image, option: exit code 2
  host,       // the machine could not keep up or lacks something: inconclusive, exit code 3
  internal,   // ours: exit code 4
};

struct Error {
  ErrorKind kind = ErrorKind::bad_input;
  std::string place;  // "hover.lua:12", "--seed", "flight.elf"; may be empty
  std::string what;   // "unknown unit 'furlong'"
  std::string cure;   // "use m, cm, mm or km"; may be empty

  // One line: "place: what (cure)".
  std::string message() const {
    std::string text = place.empty() ? what : place + ": " + what;
    if (!cure.empty()) text += " (" + cure + ")";
    return text;
  }
};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  T& value() {
    WHIRL_CHECK(ok());
    return std::get<T>(content_);
  }
  const T& value() const {
    WHIRL_CHECK(ok());
    return std::get<T>(content_);
  }
  const Error& error() const {
    WHIRL_CHECK(!ok());
    return std::get<Error>(content_);
  }

 private:
  std::variant<T, Error> content_;
};

struct Done {};  // Result<Done>: nothing to return but success

}  // namespace whirl
