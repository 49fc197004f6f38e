#include "common/bus/wire/codec_impl.hpp"

namespace limbcast::bus {

template <typename V, Of<roster::SensorAssignment> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
  field("segment", d.segment, w.segment());
}
template <typename V, Of<roster::RosterEntry> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
}
template <typename V, Of<roster::RosterEntry> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("revision", d.revision, w.revision());
  field("session", d.session, w.session());
  field("person", d.person, w.person());
  field.List("sensors", d.sensors, w.sensors(), 64);
  field("coil_slot", d.coil_slot, w.coil_slot());
  field("coil_slots", d.coil_slots, w.coil_slots());
  field("coil_frame_us", d.coil_frame_us, w.coil_frame_us());
}

template <typename V, Of<roster::SessionState> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("session_id", d.session_id, w.session_id());
}
template <typename V, Of<roster::SessionState> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("revision", d.revision, w.revision());
  field("name", d.name, w.name());
  field("partition", d.partition, w.partition());
  field("open", d.open, w.accepts_joins());
  field("performer_count", d.performer_count, w.performer_count());
  field("created_at", d.created_at, w.created_at_ns());
}

// The four request and reply types share their key.
template <typename V, typename D, typename W>
requires Of<D, roster::JoinRequest> || Of<D, roster::JoinReply> || Of<D, roster::Command> ||
    Of<D, roster::CommandReply>
void KeyFields(V& field, D& d, W& w) { field("client_uid", d.client_uid, w.client_uid()); }
template <typename V, Of<roster::JoinRequest> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("request_id", d.request_id, w.request_id());
  field("session", d.session, w.session());
  field("person", d.person, w.person());
  field("role", d.role, w.role());
  field("wants_coil_slot", d.wants_coil_slot, w.wants_coil_slot());
  field.List("sensors", d.sensors, w.sensors(), 64);
}
template <typename V, Of<roster::JoinReply> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("request_id", d.request_id, w.request_id());
  field("accepted", d.accepted, w.accepted());
  field("body_id", d.body_id, w.body_id());
  field("partition", d.partition, w.partition());
  field("message", d.message, w.message());
}
template <typename V, Of<roster::Command> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("request_id", d.request_id, w.request_id());
  field("body_id", d.body_id, w.body_id());
  field("kind", d.kind, w.kind());
  field("text", d.text, w.text());
  field.List("numbers", d.numbers, w.numbers(), 64);
}
template <typename V, Of<roster::CommandReply> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("request_id", d.request_id, w.request_id());
  field("accepted", d.accepted, w.accepted());
  field("message", d.message, w.message());
}

template struct Codec<roster::RosterEntry>;
template struct Codec<roster::SessionState>;
template struct Codec<roster::JoinRequest>;
template struct Codec<roster::JoinReply>;
template struct Codec<roster::Command>;
template struct Codec<roster::CommandReply>;

}  // namespace limbcast::bus
