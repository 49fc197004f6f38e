#pragma once

// The bodies of fast_endpoints.hpp, for the .cpp files that instantiate them.

#include <memory>
#include <utility>

#include "common/bus/fastdds/fast_endpoints.hpp"
#include "common/bus/fastdds/fast_reader.hpp"
#include "common/bus/fastdds/fast_writer.hpp"
#include "common/bus/permission.hpp"

namespace limbcast::bus::fastdds {

template <typename T>
Result<std::unique_ptr<Writer<T>>> MakeFastWriter(FastParticipant& participant) {
  auto writer = std::make_unique<FastWriter<T>>(participant);
  if (Status opened = writer->Open(); !opened) {
    return ExplainRefusal(participant.config(), "publish", Topic<T>::kShortName, opened.error());
  }
  return std::unique_ptr<Writer<T>>(std::move(writer));
}

template <typename T>
Result<std::unique_ptr<Reader<T>>> MakeFastReader(FastParticipant& participant,
                                                  ReaderHandler<T> handler) {
  auto reader = std::make_unique<FastReader<T>>(participant, std::move(handler));
  if (Status opened = reader->Open(); !opened) {
    return ExplainRefusal(participant.config(), "subscribe", Topic<T>::kShortName, opened.error());
  }
  return std::unique_ptr<Reader<T>>(std::move(reader));
}

/// Instantiates both for one topic.
// NOLINTBEGIN(bugprone-macro-parentheses): a type in parentheses is no type
#define LIMBCAST_FAST_ENDPOINTS(Domain)                                                      \
  template Result<std::unique_ptr<Writer<Domain>>> MakeFastWriter<Domain>(FastParticipant&); \
  template Result<std::unique_ptr<Reader<Domain>>> MakeFastReader<Domain>(FastParticipant&,  \
                                                                          ReaderHandler<Domain>)
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace limbcast::bus::fastdds
