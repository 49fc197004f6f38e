#include "common/bus/wire/codec_impl.hpp"

namespace limbcast::bus {

template <typename V, Of<NamedValue> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("name", d.name, w.name());
  field("value", d.value, w.number());
}
template <typename V, Of<LatencyQuantiles> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("stage", d.stage, w.stage());
  field("count", d.count, w.sample_count());
  field("p50_us", d.p50_us, w.p50_us());
  field("p99_us", d.p99_us, w.p99_us());
  field("max_us", d.max_us, w.max_us());
}
template <typename V, Of<ServiceHealth> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("process_uid", d.process_uid, w.process_uid());
}
template <typename V, Of<ServiceHealth> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("role", d.role, w.role());
  field("host", d.host, w.host());
  field("pid", d.pid, w.pid());
  field("started_at", d.started_at, w.started_at_ns());
  field("reported_at", d.reported_at, w.reported_at_ns());
  field("cpu_seconds", d.cpu_seconds, w.cpu_seconds());
  field("rss_mib", d.rss_mib, w.rss_mib());
  field.List("values", d.values, w.named_values(), 96);
  field.List("latencies", d.latencies, w.latencies(), 16);
  field("last_error", d.last_error, w.last_error());
}

template struct Codec<ServiceHealth>;

}  // namespace limbcast::bus
