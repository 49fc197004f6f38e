#pragma once

// How fields are copied. A domain type and its wire type are described once, by an overload
//   template <typename V, Of<Domain> D, typename W> void Fields(V& field, D& d, W& w)
// that calls field("name", d.name, w.name()) for each field; the visitors below turn that one list
// into encoding, decoding and checking, so the directions cannot drift apart. KeyFields lists the
// key fields in IDL order.

#include <fastcdr/Cdr.h>

#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/base/health.hpp"
#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/base/verdict.hpp"
#include "common/body/stage_times.hpp"
#include "common/bus/wire/enum_limits.hpp"
#include "common/bus/wire/instance_key.hpp"
#include "common/bus/wire/wire_types.hpp"

namespace limbcast::bus {

/// D is Domain or const Domain.
template <typename D, typename Domain>
concept Of = std::same_as<std::remove_const_t<D>, Domain>;

/// The first field that does not fit, and why.
struct Misfit {
  std::string_view field;
  std::string_view what;  // empty: everything fits
  std::size_t value = 0;
  std::size_t limit = 0;

  [[nodiscard]] bool none() const { return what.empty(); }
  void Note(std::string_view name, std::string_view problem, std::size_t is, std::size_t at_most) {
    if (none()) {
      *this = {name, problem, is, at_most};
    }
  }
};

/// fastddsgen makes this of string<N>; it holds at most N characters and no NUL.
template <typename S>
concept WireText = requires(const S& text) {
  { text.c_str() } -> std::same_as<const char*>;
  { S::max_size } -> std::convertible_to<std::size_t>;
};

inline void CheckText(Misfit& misfit, std::string_view name, const std::string& text,
                      std::size_t limit) {
  if (text.size() > limit) {
    misfit.Note(name, "characters", text.size(), limit);
  } else if (text.find('\0') != std::string::npos) {
    misfit.Note(name, "NUL characters", 1, 0);
  }
}

/// Domain to wire.
class FieldEncoder {
 public:
  Misfit misfit;

  template <typename D, typename W>
  void operator()(std::string_view name, const D& from, W& to) {
    if constexpr (std::is_arithmetic_v<D>) {
      static_assert(std::same_as<D, W>);
      to = from;
    } else if constexpr (std::is_enum_v<D>) {
      to = static_cast<W>(from);
    } else if constexpr (std::same_as<D, SensorUid> || std::same_as<D, BodyId>) {
      static_assert(std::same_as<decltype(from.value), W>);
      to = from.value;
    } else if constexpr (std::same_as<D, Time>) {
      to = ToNanoseconds(from);
    } else if constexpr (std::same_as<D, VerdictCounters>) {
      static_assert(std::same_as<decltype(from.count), W>);
      to = from.count;
    } else if constexpr (WireText<W>) {
      CheckText(misfit, name, from, W::max_size);
      to = from.c_str();
    } else {
      Fields(*this, from, to);
    }
  }
  template <typename D, typename W, std::size_t N>
  void operator()(std::string_view name, const std::array<D, N>& from, std::array<W, N>& to) {
    for (std::size_t i = 0; i < N; ++i) {
      (*this)(name, from[i], to[i]);
    }
  }
  template <typename D, typename W>
  void List(std::string_view name, const std::vector<D>& from, std::vector<W>& to,
            std::size_t limit) {
    if (from.size() > limit) {
      misfit.Note(name, "elements", from.size(), limit);
      return;
    }
    to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      (*this)(name, from[i], to[i]);
    }
  }
};

/// Wire to domain.
class FieldDecoder {
 public:
  Misfit misfit;

  template <typename D, typename W>
  void operator()(std::string_view name, D& to, const W& from) {
    if constexpr (std::is_arithmetic_v<D>) {
      static_assert(std::same_as<D, W>);
      to = from;
    } else if constexpr (std::is_enum_v<D>) {
      constexpr auto kLast = static_cast<std::underlying_type_t<D>>(kLastOf<D>);
      static_assert(kLast > 0, "give it a kLastOf in enum_limits.hpp");
      if (from > kLast) {
        misfit.Note(name, "as its number", from, kLast);
      } else {
        to = static_cast<D>(from);
      }
    } else if constexpr (std::same_as<D, SensorUid> || std::same_as<D, BodyId>) {
      to.value = from;
    } else if constexpr (std::same_as<D, Time>) {
      to = TimeFromNanoseconds(from);
    } else if constexpr (std::same_as<D, VerdictCounters>) {
      to.count = from;
    } else if constexpr (WireText<W>) {
      to.assign(from.c_str(), from.size());
    } else {
      Fields(*this, to, from);
    }
  }
  template <typename D, typename W, std::size_t N>
  void operator()(std::string_view name, std::array<D, N>& to, const std::array<W, N>& from) {
    for (std::size_t i = 0; i < N; ++i) {
      (*this)(name, to[i], from[i]);
    }
  }
  template <typename D, typename W>
  void List(std::string_view name, std::vector<D>& to, const std::vector<W>& from,
            std::size_t limit) {
    if (from.size() > limit) {
      misfit.Note(name, "elements", from.size(), limit);
      return;
    }
    to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      (*this)(name, to[i], from[i]);
    }
  }
};

/// Looks at the bounds of a domain value only; the wire object lends its types.
class FieldChecker {
 public:
  Misfit misfit;

  template <typename D, typename W>
  void operator()(std::string_view name, const D& value, const W&) {
    if constexpr (WireText<W>) {
      CheckText(misfit, name, value, W::max_size);
    }
  }
  template <typename D, typename W>
  void List(std::string_view name, const std::vector<D>& values, const std::vector<W>&,
            std::size_t limit) {
    if (values.size() > limit) {
      misfit.Note(name, "elements", values.size(), limit);
      return;
    }
    if constexpr (!std::is_arithmetic_v<D>) {
      static const W kTypes{};
      for (const D& value : values) {
        Fields(*this, value, kTypes);
      }
    }
  }
};

/// Puts the key fields of a domain value one after the other.
class KeyPacker {
 public:
  InstanceKey key;

  template <typename D, typename W>
  void operator()(std::string_view, const D& value, const W&) {
    static_assert(std::is_trivially_copyable_v<D>);
    std::memcpy(key.bytes.data() + size_, &value, sizeof(D));
    size_ += sizeof(D);
  }

 private:
  std::size_t size_ = 0;
};

/// Reads key fields from CDR into a wire object.
class KeyReader {
 public:
  explicit KeyReader(eprosima::fastcdr::Cdr& cdr) : cdr_(cdr) {}
  template <typename D, typename W>
  void operator()(std::string_view, const D&, W& to) {
    cdr_ >> to;
  }

 private:
  eprosima::fastcdr::Cdr& cdr_;
};

// ---- the small types that topics share ----

template <typename V, typename D, typename W>
requires Of<D, Eigen::Vector3f> || Of<D, Eigen::Vector3d>
void Fields(V& field, D& d, W& w) {
  field("x", d.x(), w.x());
  field("y", d.y(), w.y());
  field("z", d.z(), w.z());
}
template <typename V, typename D, typename W>
requires Of<D, Eigen::Quaternionf> || Of<D, Eigen::Quaterniond>
void Fields(V& field, D& d, W& w) {
  field("w", d.w(), w.w());
  field("x", d.x(), w.x());
  field("y", d.y(), w.y());
  field("z", d.z(), w.z());
}
template <typename V, typename D, typename W>
requires Of<D, Eigen::Matrix3f> || Of<D, Eigen::Matrix3d>
void Fields(V& field, D& d, W& w) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      field("element", d(row, column), w[static_cast<std::size_t>(3 * row + column)]);
    }
  }
}

template <typename V, Of<body::StageTimes> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("gateway_published_at", d.gateway_published_at, w.gateway_published_at_ns());
  field("fusion_received_at", d.fusion_received_at, w.fusion_received_at_ns());
  field("fusion_published_at", d.fusion_published_at, w.fusion_published_at_ns());
  field("posture_received_at", d.posture_received_at, w.posture_received_at_ns());
  field("posture_published_at", d.posture_published_at, w.posture_published_at_ns());
}

}  // namespace limbcast::bus
