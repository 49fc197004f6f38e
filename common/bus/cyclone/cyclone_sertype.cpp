#include "common/bus/cyclone/cyclone_sertype.hpp"

#include <dds/ddsi/q_radmin.h>
#include <dds/ddsrt/md5.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

// The interface is that of Cyclone DDS 0.10 (CMakeLists.txt checks). What it must do and why is
// measured in the project's DDS notes: from_keyhash must exist (Fast DDS disposes with the hash
// alone), to_untyped clears the type, hashes include serdata_basehash.

namespace limbcast::bus::cyclone {
namespace {

struct Sertype : ddsi_sertype {
  const WireOps* wire;
  MalformedHandler on_malformed;
};

// A sample: this header and its bytes behind it, in one allocation.
struct Serdata : ddsi_serdata {
  KeyHash key;
  std::size_t size;      // of the encapsulated CDR
  std::size_t capacity;  // multiple of 4, >= size

  [[nodiscard]] char* bytes() { return reinterpret_cast<char*>(this + 1); }
  [[nodiscard]] const char* bytes() const { return reinterpret_cast<const char*>(this + 1); }
};

constexpr std::size_t Padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

const Sertype& TypeOf(const ddsi_sertype* type) { return *static_cast<const Sertype*>(type); }
const Serdata& DataOf(const ddsi_serdata* data) { return *static_cast<const Serdata*>(data); }

// Fast DDS 2.9 takes a key-only payload of up to 16 bytes for the key hash, header and byte order
// included, and then disposes an instance that nobody knows. Longer ones it ignores, and uses the
// hash that comes along (GenerateKeyhash in the domain's configuration).
constexpr std::size_t kMinKeyPayload_bytes = 20;
static_assert(kMinKeyPayload_bytes > 16 && kMinKeyPayload_bytes <= kMaxKeyCdr_bytes);

Serdata* NewSerdata(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  const std::size_t capacity =
      kind == SDK_KEY ? std::max(Padded(size), kMinKeyPayload_bytes) : Padded(size);
  void* memory = std::malloc(sizeof(Serdata) + capacity);
  if (memory == nullptr) {
    std::abort();  // as the library does
  }
  auto* data = new (memory) Serdata();
  ddsi_serdata_init(data, type, kind);
  data->size = size;
  data->capacity = capacity;
  std::memset(data->bytes() + size, 0, capacity - size);
  return data;
}

void SetKey(Serdata& data, const KeyHash& key, std::uint32_t basehash) {
  data.key = key;
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const std::uint8_t byte : key) {
    hash = (hash ^ byte) * 16777619U;
  }
  data.hash = hash ^ basehash;
}

void FreeSerdata(ddsi_serdata* data) {
  static_cast<Serdata*>(data)->~Serdata();
  std::free(static_cast<void*>(static_cast<Serdata*>(data)));
}

ddsi_serdata* Finish(Serdata* data) {
  const Sertype& type = TypeOf(data->type);
  KeyHash key{};
  if (data->kind == SDK_EMPTY ||
      !type.wire->read_key({data->bytes(), data->size}, data->kind == SDK_KEY, key)) {
    if (type.on_malformed) {
      type.on_malformed("bytes without a key of the type");
    }
    FreeSerdata(data);
    return nullptr;  // dropped by the library
  }
  SetKey(*data, key, type.serdata_basehash);
  return data;
}

// ---- ddsi_serdata_ops ----

bool EqualKey(const ddsi_serdata* a, const ddsi_serdata* b) {
  return DataOf(a).key == DataOf(b).key;
}

std::uint32_t Size(const ddsi_serdata* data) {
  return static_cast<std::uint32_t>(DataOf(data).capacity);
}

ddsi_serdata* FromSer(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                      std::size_t size) {
  Serdata* data = NewSerdata(type, kind, size);
  std::uint32_t offset = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 > offset) {  // fragments may overlap
      const unsigned char* payload =
          NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
      std::memcpy(data->bytes() + offset, payload + (offset - fragment->min),
                  fragment->maxp1 - offset);
      offset = fragment->maxp1;
    }
  }
  return Finish(data);
}

ddsi_serdata* FromSerIov(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) {
  Serdata* data = NewSerdata(type, kind, size);
  std::size_t offset = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && offset < size; ++i) {
    const std::size_t length = std::min(parts[i].iov_len, size - offset);
    std::memcpy(data->bytes() + offset, parts[i].iov_base, length);
    offset += length;
  }
  return Finish(data);
}

ddsi_serdata* FromKeyHash(const ddsi_sertype* type, const ddsi_keyhash* hash) {
  const Sertype& sertype = TypeOf(type);
  KeyHash key{};
  std::memcpy(key.data(), hash->value, key.size());
  std::array<char, kMaxKeyCdr_bytes> cdr{};
  const std::size_t size = sertype.wire->serialize_key_hash(key, cdr);
  Serdata* data = NewSerdata(type, SDK_KEY, size);
  std::memcpy(data->bytes(), cdr.data(), size);
  SetKey(*data, key, sertype.serdata_basehash);
  return data;
}

ddsi_serdata* FromSample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  const Sertype& sertype = TypeOf(type);
  Serdata* data = nullptr;
  if (kind == SDK_KEY) {
    std::array<char, kMaxKeyCdr_bytes> cdr{};
    const std::size_t size = sertype.wire->serialize_key(sample, cdr);
    data = NewSerdata(type, kind, size);
    std::memcpy(data->bytes(), cdr.data(), size);
  } else {
    data = NewSerdata(type, kind, sertype.wire->serialized_size(sample));
    if (sertype.wire->serialize(sample, {data->bytes(), data->size}) != data->size) {
      FreeSerdata(data);
      return nullptr;
    }
  }
  SetKey(*data, sertype.wire->hash_key(sample), sertype.serdata_basehash);
  return data;
}

void ToSer(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* out) {
  std::memcpy(out, DataOf(data).bytes() + offset, size);
}

ddsi_serdata* ToSerRef(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                       ddsrt_iovec_t* out) {
  out->iov_base = const_cast<char*>(DataOf(data).bytes() + offset);
  out->iov_len = size;
  return ddsi_serdata_ref(data);
}

void ToSerUnref(ddsi_serdata* data, const ddsrt_iovec_t* /*part*/) { ddsi_serdata_unref(data); }

bool ToSample(const ddsi_serdata* data, void* sample, void** /*buffer*/, void* /*limit*/) {
  return data->kind == SDK_DATA && TypeOf(data->type).wire->deserialize(Payload(data), sample);
}

ddsi_serdata* ToUntyped(const ddsi_serdata* data) {
  const Sertype& sertype = TypeOf(data->type);
  std::array<char, kMaxKeyCdr_bytes> cdr{};
  const std::size_t size = sertype.wire->serialize_key_hash(DataOf(data).key, cdr);
  Serdata* untyped = NewSerdata(data->type, SDK_KEY, size);
  std::memcpy(untyped->bytes(), cdr.data(), size);
  untyped->key = DataOf(data).key;
  untyped->hash = data->hash;
  untyped->type = nullptr;
  return untyped;
}

bool UntypedToSample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*data*/, void* /*sample*/,
                     void** /*buffer*/, void* /*limit*/) {
  return false;  // keys are taken from Payload
}

std::size_t Print(const ddsi_sertype* type, const ddsi_serdata* /*data*/, char* out,
                  std::size_t size) {
  if (size == 0) {
    return 0;
  }
  std::strncpy(out, TypeOf(type).wire->type_name, size - 1);
  out[size - 1] = '\0';
  return std::strlen(out);
}

void GetKeyHash(const ddsi_serdata* data, ddsi_keyhash* out, bool force_md5) {
  const KeyHash& key = DataOf(data).key;
  if (!force_md5) {
    std::memcpy(out->value, key.data(), key.size());
    return;
  }
  ddsrt_md5_state_t state;
  ddsrt_md5_init(&state);
  ddsrt_md5_append(&state, key.data(), static_cast<unsigned>(key.size()));
  ddsrt_md5_finish(&state, out->value);
}

// ---- ddsi_sertype_ops ----

void FreeSertype(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<Sertype*>(type);
}

// Samples are taken as serdata only, so the library never makes any.
void ZeroSamples(const ddsi_sertype* /*type*/, void* /*samples*/, std::size_t /*count*/) {}
void ReallocSamples(void** pointers, const ddsi_sertype* /*type*/, void* /*old*/,
                    std::size_t /*old_count*/, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    pointers[i] = nullptr;
  }
}
void FreeSamples(const ddsi_sertype* /*type*/, void** /*pointers*/, std::size_t /*count*/,
                 dds_free_op_t /*operation*/) {}
// Each bus has its own, because each has its own counters.
bool EqualType(const ddsi_sertype* a, const ddsi_sertype* b) { return a == b; }
std::uint32_t HashType(const ddsi_sertype* /*type*/) { return 0; }
std::size_t SerializedSize(const ddsi_sertype* type, const void* sample) {
  return TypeOf(type).wire->serialized_size(sample);
}
bool SerializeInto(const ddsi_sertype* type, const void* sample, void* out, std::size_t size) {
  return TypeOf(type).wire->serialize(sample, {static_cast<char*>(out), size}) != 0;
}

#ifdef DDS_HAS_SHM
std::uint32_t SharedMemorySize(const ddsi_serdata* /*data*/) { return 0; }
ddsi_serdata* FromSharedMemory(const ddsi_sertype* /*type*/, ddsi_serdata_kind /*kind*/,
                               void* /*subscriber*/, void* /*chunk*/) {
  return nullptr;
}
#endif

const ddsi_serdata_ops kSerdataOps = {
    .eqkey = EqualKey,
    .get_size = Size,
    .from_ser = FromSer,
    .from_ser_iov = FromSerIov,
    .from_keyhash = FromKeyHash,
    .from_sample = FromSample,
    .to_ser = ToSer,
    .to_ser_ref = ToSerRef,
    .to_ser_unref = ToSerUnref,
    .to_sample = ToSample,
    .to_untyped = ToUntyped,
    .untyped_to_sample = UntypedToSample,
    .free = FreeSerdata,
    .print = Print,
    .get_keyhash = GetKeyHash,
#ifdef DDS_HAS_SHM
    .get_sample_size = SharedMemorySize,
    .from_iox_buffer = FromSharedMemory,
#endif
};

const ddsi_sertype_ops kSertypeOps = {
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free = FreeSertype,
    .zero_samples = ZeroSamples,
    .realloc_samples = ReallocSamples,
    .free_samples = FreeSamples,
    .equal = EqualType,
    .hash = HashType,
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = SerializedSize,
    .serialize_into = SerializeInto,
};

}  // namespace

ddsi_sertype* MakeSertype(const WireOps& ops, MalformedHandler on_malformed) {
  auto* type = new Sertype();  // value-initialised: the library wants zeros
  ddsi_sertype_init(type, ops.type_name, &kSertypeOps, &kSerdataOps, /*topickind_no_key=*/false);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  type->wire = &ops;
  type->on_malformed = std::move(on_malformed);
  return type;
}

std::span<const char> Payload(const ddsi_serdata* data) {
  return {DataOf(data).bytes(), DataOf(data).size};
}

ddsi_serdata* MakeDisposal(const ddsi_sertype* type, const void* wire) {
  ddsi_serdata* data = FromSample(type, SDK_KEY, wire);
  data->statusinfo = NN_STATUSINFO_DISPOSE | NN_STATUSINFO_UNREGISTER;
  data->timestamp.v = dds_time();
  return data;
}

ddsi_serdata* MakeSerdata(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          std::span<const char> bytes) {
  Serdata* data = NewSerdata(type, kind, bytes.size());
  if (!bytes.empty()) {
    std::memcpy(data->bytes(), bytes.data(), bytes.size());
  }
  return Finish(data);
}

}  // namespace limbcast::bus::cyclone
