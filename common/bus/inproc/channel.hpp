#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "common/base/clock.hpp"
#include "common/bus/endpoint_events.hpp"
#include "common/bus/inproc/mailbox.hpp"
#include "common/bus/inproc/partition.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/wire/codec.hpp"

namespace limbcast::bus::inproc {

template <typename T>
struct WriterEnd {
  WriterEnd(std::string in_partition, std::int32_t with_strength, std::shared_ptr<EventSink> sink)
      : partition(std::move(in_partition)),
        strength(with_strength),
        events(Topic<T>::kShortName, true, std::move(sink)) {}

  struct Kept {
    T value;
    std::uint64_t order = 0;  // of the channel's writes
  };
  const std::string partition;
  const std::int32_t strength;
  EndpointEvents events;
  // Guarded by the channel.
  std::uint64_t id = 0;  // grows with age; ties of strength go to the oldest
  std::int32_t matched = 0;
  std::unordered_map<InstanceKey, Kept> last;  // state topics
  std::unordered_set<InstanceKey> written;     // exclusive topics: instances it competes for
};

template <typename T>
struct ReaderEnd {
  ReaderEnd(std::string in_partition, ReaderHandler<T> handler, std::shared_ptr<EventSink> sink)
      : partition(std::move(in_partition)),
        events(Topic<T>::kShortName, false, std::move(sink)),
        mailbox(std::move(handler), events) {}

  const std::string partition;
  EndpointEvents events;
  Mailbox<T> mailbox;
  std::int32_t matched = 0;  // guarded by the channel
};

/// One topic of one domain inside this process. Thread-safe.
template <typename T>
class Channel {
 public:
  using WriterPtr = std::shared_ptr<WriterEnd<T>>;
  using ReaderPtr = std::shared_ptr<ReaderEnd<T>>;

  void AddWriter(const WriterPtr& writer) {
    const std::scoped_lock order(topology_mutex_);
    std::vector<ReaderPtr> peers;
    {
      const std::scoped_lock lock(mutex_);
      writer->id = ++next_id_;
      writers_.push_back(writer);
      peers = PeersOf(*writer);
    }
    for (const ReaderPtr& reader : peers) {
      writer->events.Matched(1, ++writer->matched);
      reader->events.Matched(1, ++reader->matched);
      reader->events.Liveliness(reader->matched, 0);
    }
  }

  void RemoveWriter(const WriterPtr& writer) {
    const std::scoped_lock order(topology_mutex_);
    std::vector<ReaderPtr> peers;
    {
      const std::scoped_lock lock(mutex_);
      std::erase(writers_, writer);
      peers = PeersOf(*writer);
    }
    for (const ReaderPtr& reader : peers) {
      reader->events.Matched(-1, --reader->matched);
      reader->events.Liveliness(reader->matched, 0);
    }
  }

  void AddReader(const ReaderPtr& reader) {
    std::vector<WriterPtr> peers;
    reader->mailbox.Hold();
    {
      const std::scoped_lock order(topology_mutex_);
      {
        const std::scoped_lock lock(mutex_);
        auto readers = std::make_shared<Readers>(*readers_);
        readers->push_back(reader);
        readers_ = std::move(readers);
        Replay(*reader);
        std::copy_if(writers_.begin(), writers_.end(), std::back_inserter(peers),
                     [&](const WriterPtr& writer) {
                       return PartitionsMatch(writer->partition, reader->partition);
                     });
      }
      for (const WriterPtr& writer : peers) {
        writer->events.Matched(1, ++writer->matched);
        reader->events.Matched(1, ++reader->matched);
        reader->events.Liveliness(reader->matched, 0);
      }
    }
    reader->mailbox.Release();
  }

  void RemoveReader(const ReaderPtr& reader) {
    {
      const std::scoped_lock order(topology_mutex_);
      std::vector<WriterPtr> peers;
      {
        const std::scoped_lock lock(mutex_);
        auto readers = std::make_shared<Readers>(*readers_);
        std::erase(*readers, reader);
        readers_ = std::move(readers);
        peers = writers_;
      }
      for (const WriterPtr& writer : peers) {
        if (PartitionsMatch(writer->partition, reader->partition)) {
          writer->events.Matched(-1, --writer->matched);
        }
      }
    }
    reader->mailbox.Close();
  }

  void Write(WriterEnd<T>& writer, const T& value, Time received_at) {
    const SampleInfo info{.received_at = received_at};
    Deliver(writer, value, /*dispose=*/false,
            [&](ReaderEnd<T>& reader) { reader.mailbox.Sample(value, info); });
  }

  void Dispose(WriterEnd<T>& writer, const T& key) {
    Deliver(writer, key, /*dispose=*/true,
            [&](ReaderEnd<T>& reader) { reader.mailbox.Disposed(key); });
  }

 private:
  using Readers = std::vector<ReaderPtr>;

  template <typename Give>
  void Deliver(WriterEnd<T>& writer, const T& value, bool dispose, Give give) {
    std::shared_ptr<const Readers> readers;
    std::vector<WriterPtr> rivals;  // stronger writers of this instance; nearly always none
    {
      const std::scoped_lock lock(mutex_);
      Keep(writer, value, dispose, rivals);
      readers = readers_;
    }
    for (const ReaderPtr& reader : *readers) {
      const auto heard = [&](const WriterPtr& rival) {
        return PartitionsMatch(rival->partition, reader->partition);
      };
      if (PartitionsMatch(writer.partition, reader->partition) &&
          std::none_of(rivals.begin(), rivals.end(), heard)) {
        give(*reader);
      }
    }
  }

  // Remembers what late joiners get and who competes for the instance.
  void Keep(WriterEnd<T>& writer, const T& value, bool dispose, std::vector<WriterPtr>& rivals) {
    if constexpr (Topic<T>::kProfile == QosProfile::kState) {
      const InstanceKey key = Codec<T>::Key(value);
      if (dispose) {
        for (const WriterPtr& other : writers_) {
          if (PartitionsMatch(other->partition, writer.partition)) {
            other->last.erase(key);
          }
        }
      } else {
        writer.last.insert_or_assign(key, typename WriterEnd<T>::Kept{value, ++next_order_});
      }
    }
    if constexpr (Topic<T>::kExclusiveOwnership) {
      const InstanceKey key = Codec<T>::Key(value);
      writer.written.insert(key);
      for (const WriterPtr& other : writers_) {
        const bool stronger = other->strength > writer.strength ||
                              (other->strength == writer.strength && other->id < writer.id);
        if (stronger && other->written.contains(key)) {
          rivals.push_back(other);
        }
      }
      if (dispose) {
        writer.written.erase(key);
      }
    }
  }

  void Replay(ReaderEnd<T>& reader) {
    if constexpr (Topic<T>::kProfile == QosProfile::kState) {
      std::vector<const typename WriterEnd<T>::Kept*> kept;
      for (const WriterPtr& writer : writers_) {
        if (PartitionsMatch(writer->partition, reader.partition)) {
          for (const auto& [key, last] : writer->last) {
            kept.push_back(&last);
          }
        }
      }
      std::sort(kept.begin(), kept.end(),
                [](const auto* a, const auto* b) { return a->order < b->order; });
      for (const auto* last : kept) {
        reader.mailbox.Sample(last->value, {});
      }
    }
  }

  std::vector<ReaderPtr> PeersOf(const WriterEnd<T>& writer) const {
    std::vector<ReaderPtr> peers;
    std::copy_if(readers_->begin(), readers_->end(), std::back_inserter(peers),
                 [&](const ReaderPtr& reader) {
                   return PartitionsMatch(writer.partition, reader->partition);
                 });
    return peers;
  }

  // Held over a change of the topology and its events, so that counts arrive in order; recursive
  // because an event handler may make or destroy endpoints. Guards matched of all ends.
  std::recursive_mutex topology_mutex_;
  std::mutex mutex_;  // guards the rest; held for lookups only
  std::vector<WriterPtr> writers_;
  std::shared_ptr<const Readers> readers_ = std::make_shared<Readers>();
  std::uint64_t next_id_ = 0;
  std::uint64_t next_order_ = 0;
};

}  // namespace limbcast::bus::inproc
