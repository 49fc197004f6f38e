#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "common/base/expects.hpp"

namespace limbcast {

/// What kind of refusal an Error is. Callers branch on this, people read the message.
enum class ErrorCode {
  kInvalidArgument,  ///< a value outside its range, an unknown key or option
  kNotFound,         ///< a file, a topic, a sensor that is not there
  kUnavailable,      ///< a device, port, domain or service that refuses now
  kTimeout,          ///< no answer in time
  kCorruptData,      ///< bytes that are not what they claim to be
  kUnsupported,      ///< understood, but not offered by this build or back end
};

/// A refusal of the world. `message` names the thing, the value and the limit, in one line.
struct Error {
  ErrorCode code = ErrorCode::kInvalidArgument;
  std::string message;
};

/// Either a value or an Error. Thread-compatible. Reading the side that is not there aborts.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value)
      : content_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit by design
  Result(Error error)
      : content_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit by design

  [[nodiscard]] bool ok() const { return content_.index() == 0; }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] const T& value() const& {
    Expects(ok(), "a Result with a value");
    return std::get<0>(content_);
  }
  [[nodiscard]] T& value() & {
    Expects(ok(), "a Result with a value");
    return std::get<0>(content_);
  }
  [[nodiscard]] T&& value() && {
    Expects(ok(), "a Result with a value");
    return std::get<0>(std::move(content_));
  }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }
  [[nodiscard]] T* operator->() { return &value(); }

  [[nodiscard]] const Error& error() const {
    Expects(!ok(), "a Result with an error");
    return std::get<1>(content_);
  }

 private:
  std::variant<T, Error> content_;
};

/// Success, or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_(std::move(error)) {}  // NOLINT: implicit by design

  [[nodiscard]] bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }
  [[nodiscard]] const Error& error() const {
    Expects(!ok(), "a Status with an error");
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

[[nodiscard]] inline Status Ok() { return {}; }

}  // namespace limbcast
