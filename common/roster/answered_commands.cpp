#include "common/roster/answered_commands.hpp"

namespace limbcast::roster {

const CommandReply* AnsweredCommands::Find(const Command& command) const {
  const auto found = last_.find(command.client_uid);
  const bool same = found != last_.end() && found->second.request_id == command.request_id;
  return same ? &found->second : nullptr;
}

void AnsweredCommands::Add(const CommandReply& reply) {
  const auto [place, is_new] = last_.insert_or_assign(reply.client_uid, reply);
  if (!is_new) {
    return;
  }
  order_.push_back(reply.client_uid);
  if (order_.size() > kMost) {
    last_.erase(order_.front());
    order_.pop_front();
  }
}

}  // namespace limbcast::roster
