#include "tests/conformance/topic_writer.hpp"

#include <tuple>
#include <utility>

#include "common/bus/wire/codec.hpp"
#include "tests/support/topic_examples.hpp"

namespace limbcast::conformance {
namespace {

using test_support::Example;

template <typename T>
class TypedTopicWriter final : public TopicWriter {
 public:
  explicit TypedTopicWriter(std::unique_ptr<bus::Writer<T>> writer) : writer_(std::move(writer)) {}
  Status Write(std::uint32_t key, std::uint32_t sequence) override {
    Status written = writer_->Write(Example<T>(key, sequence));
    writer_->Flush();
    return written;
  }
  Status Dispose(std::uint32_t key) override {
    Status disposed = writer_->Dispose(Example<T>(key, 1));
    writer_->Flush();
    return disposed;
  }
  [[nodiscard]] bus::EndpointCounters counters() const override { return writer_->counters(); }

 private:
  std::unique_ptr<bus::Writer<T>> writer_;
};

// Calls visit(TypeTag<T>{}) for the topic of that short name; false when there is none.
template <typename Visit, typename... Ts>
bool VisitTopic(std::string_view topic, Visit visit, bus::TypeTag<std::tuple<Ts...>> /*list*/) {
  return ((bus::Topic<Ts>::kShortName == topic && (visit(bus::TypeTag<Ts>{}), true)) || ...);
}
template <typename Visit>
bool VisitTopic(std::string_view topic, Visit visit) {
  return VisitTopic(topic, visit, bus::TypeTag<bus::AllTopics>{});
}

Error NoTopic(std::string_view topic) {
  return Error{ErrorCode::kNotFound, "no topic '" + std::string(topic) + "'"};
}

void PutUint32(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes.at(at + i) = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

template <typename T>
Bytes GoodBytes(std::uint32_t sequence) {
  const std::string text = test_support::WireBytes(Example<T>(kGarbageKey, sequence));
  return {text.begin(), text.end()};
}

}  // namespace

Result<std::unique_ptr<TopicWriter>> MakeTopicWriter(bus::Bus& bus, std::string_view topic) {
  Result<std::unique_ptr<TopicWriter>> made = NoTopic(topic);
  VisitTopic(topic, [&]<typename T>(bus::TypeTag<T>) {
    auto writer = bus.MakeWriter<T>();
    if (writer) {
      made = std::unique_ptr<TopicWriter>(
          std::make_unique<TypedTopicWriter<T>>(std::move(writer).value()));
    } else {
      made = writer.error();
    }
  });
  return made;
}

Result<TopicNames> NamesOf(std::string_view topic) {
  TopicNames names;
  const bool found = VisitTopic(topic, [&]<typename T>(bus::TypeTag<T>) {
    names = {std::string(bus::Topic<T>::kName), bus::Codec<T>::kTypeName, bus::Topic<T>::kProfile,
             bus::Topic<T>::kExclusiveOwnership};
  });
  if (!found) {
    return NoTopic(topic);
  }
  return names;
}

std::vector<Bytes> Garbage(std::string_view topic) {
  constexpr std::size_t kHeader = 4;  // encapsulation
  std::vector<Bytes> garbage;
  VisitTopic(topic, [&]<typename T>(bus::TypeTag<T>) {
    const Bytes good = GoodBytes<T>(1);
    garbage.emplace_back(good.begin(), good.begin() + kHeader);
    garbage.emplace_back(good.begin(),
                         good.begin() + static_cast<std::ptrdiff_t>(good.size() / 2 / 4 * 4));
    garbage.push_back(good);
    garbage.back().resize(good.size() / 4 * 4 + 64, 0xAA);
  });
  if (topic == bus::Topic<sensing::MargFrame>::kShortName) {
    // body_id, gateway, length of the list
    constexpr std::size_t kLengthAt = kHeader + 8;
    for (const std::uint32_t length : {0xFFFF'FFFFU, 0x7FFF'FFFFU, 65U}) {
      garbage.emplace_back(Bytes(60'000, 0));
      garbage.back()[1] = 1;
      PutUint32(garbage.back(), kLengthAt, length);
    }
  }
  if (topic == bus::Topic<body::SegmentState>::kShortName) {
    garbage.push_back(GoodBytes<body::SegmentState>(1));
    garbage.back()[kHeader + 6] = 200;  // body_id, segment, slot, then the verdict
  }
  if (topic == bus::Topic<body::SegmentFrame>::kShortName) {
    constexpr std::size_t kLengthAt = kHeader + 4;  // after body_id
    for (const std::uint32_t length : {0xFFFF'FFFFU, 0x7FFF'FFFFU, 65U}) {
      garbage.emplace_back(Bytes(60'000, 0));
      garbage.back()[1] = 1;
      PutUint32(garbage.back(), kLengthAt, length);
    }
  }
  return garbage;
}

std::vector<Bytes> BadEncapsulations(std::string_view topic) {
  std::vector<Bytes> garbage(1, Bytes(100, 0xFF));
  VisitTopic(topic, [&]<typename T>(bus::TypeTag<T>) {
    garbage.push_back(GoodBytes<T>(1));
    garbage.back()[1] = 0x99;
  });
  return garbage;
}

}  // namespace limbcast::conformance
