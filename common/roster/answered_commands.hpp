#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <unordered_map>

#include "common/roster/command.hpp"

namespace limbcast::roster {

/// The last answer to each client, so that a request that is repeated (its answer may have been
/// lost while the two were finding each other) is answered again and not done again. The oldest are
/// forgotten. Thread-compatible.
class AnsweredCommands {
 public:
  static constexpr std::size_t kMost = 1024;

  /// The answer to the very same request; null when it is a new one. Valid until Add.
  [[nodiscard]] const CommandReply* Find(const Command& command) const;
  void Add(const CommandReply& reply);
  [[nodiscard]] std::size_t size() const { return last_.size(); }

 private:
  std::unordered_map<std::uint64_t, CommandReply> last_;  // by client_uid
  std::deque<std::uint64_t> order_;                       // of their first answers
};

}  // namespace limbcast::roster
