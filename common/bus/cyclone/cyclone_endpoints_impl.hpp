#pragma once

// The bodies of cyclone_endpoints.hpp, for the .cpp files that instantiate them.

#include <memory>
#include <utility>

#include "common/bus/cyclone/cyclone_endpoints.hpp"
#include "common/bus/cyclone/cyclone_reader.hpp"
#include "common/bus/cyclone/cyclone_writer.hpp"
#include "common/bus/permission.hpp"

namespace limbcast::bus::cyclone {

template <typename T>
Result<std::unique_ptr<Writer<T>>> MakeCycloneWriter(CycloneParticipant& participant) {
  auto writer = std::make_unique<CycloneWriter<T>>(participant);
  if (Status opened = writer->Open(); !opened) {
    return ExplainRefusal(participant.config(), "publish", Topic<T>::kShortName, opened.error());
  }
  return std::unique_ptr<Writer<T>>(std::move(writer));
}

template <typename T>
Result<std::unique_ptr<Reader<T>>> MakeCycloneReader(CycloneParticipant& participant,
                                                     ReaderHandler<T> handler) {
  auto reader = std::make_unique<CycloneReader<T>>(participant, std::move(handler));
  if (Status opened = reader->Open(); !opened) {
    return ExplainRefusal(participant.config(), "subscribe", Topic<T>::kShortName, opened.error());
  }
  return std::unique_ptr<Reader<T>>(std::move(reader));
}

/// Instantiates both for one topic.
// NOLINTBEGIN(bugprone-macro-parentheses): a type in parentheses is no type
#define LIMBCAST_CYCLONE_ENDPOINTS(Domain)                                                         \
  template Result<std::unique_ptr<Writer<Domain>>> MakeCycloneWriter<Domain>(CycloneParticipant&); \
  template Result<std::unique_ptr<Reader<Domain>>> MakeCycloneReader<Domain>(                      \
      CycloneParticipant&, ReaderHandler<Domain>)
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace limbcast::bus::cyclone
