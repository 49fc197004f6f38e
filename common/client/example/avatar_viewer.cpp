// Watches everybody in a session, as a VR program would once a frame. Copy and change.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "common/client/client.hpp"
#include "common/units/viewer_axes.hpp"

int main(int argc, char** argv) {
  using namespace limbcast;
  client::ClientOptions options;
  options.dds = argc > 1 ? argv[1] : "cyclone";
  if (argc > 2) options.domain_id = static_cast<std::uint32_t>(std::atoi(argv[2]));
  const int frames = argc > 3 ? std::atoi(argv[3]) : 300;
  if (argc > 4) options.session = argv[4];  // as a spectator

  const auto connected = client::Client::Connect(options);
  if (!connected) {
    std::fprintf(stderr, "limbcast-example-viewer: %s\n", connected.error().message.c_str());
    return 2;
  }
  client::Client& session = **connected;
  std::printf("on %s\n", session.Describe().c_str());

  const auto frame_time = std::chrono::microseconds(11'111);  // 90 Hz
  for (int frame = 0; frame < frames; ++frame) {
    std::this_thread::sleep_for(frame_time);
    const Time display_time = session.Now() + std::chrono::milliseconds(5);  // when it is seen
    for (const BodyId body_id : session.Bodies()) {
      const auto pose = session.PoseAt(body_id, display_time);
      if (!pose || frame % 90 != 0) continue;  // draw every frame; print once a second
      std::printf("body %u, pose %.1f ms old\n", body_id.value, ToSeconds(pose->age) * 1e3);
      for (const body::SegmentPose& segment : pose->segments) {
        if (segment.status == body::SegmentStatus::kMissing) continue;  // fade it out
        // The engine's axes: OpenXR here, kUnity or kGltf for others.
        const Eigen::Vector3d p_m =
            units::VectorIn(units::ViewerAxes::kOpenXr, segment.p_earth_segment_m.cast<double>());
        const Eigen::Quaterniond q =
            units::RotationIn(units::ViewerAxes::kOpenXr, segment.q_earth_segment.cast<double>());
        std::printf("  %-16s at (%5.2f %5.2f %5.2f) m, q (%5.2f %5.2f %5.2f %5.2f), sure %.2f\n",
                    std::string(body::ToString(segment.segment)).c_str(), p_m.x(), p_m.y(), p_m.z(),
                    q.w(), q.x(), q.y(), q.z(), static_cast<double>(segment.confidence));
      }
    }
  }
  return EXIT_SUCCESS;
}
