#include "services/gateway/drivers/replay/broad_reader.hpp"

#include <cmath>

#include "common/math/rotation.hpp"
#include "common/units/units.hpp"

namespace limbcast::gateway {

namespace {

struct Tables {
  NumberTable gyro, accel, mag, truth_q, truth_p, movement;
};

Result<Tables> ReadTables(const Hdf5File& file) {
  Tables tables;
  struct Wanted {
    const char* name;
    std::size_t columns;
    NumberTable* table;
  };
  for (const Wanted& wanted : {Wanted{"/imu_gyr", 3, &tables.gyro},
                               {"/imu_acc", 3, &tables.accel},
                               {"/imu_mag", 3, &tables.mag},
                               {"/opt_quat", 4, &tables.truth_q},
                               {"/opt_pos", 3, &tables.truth_p},
                               {"/movement", 1, &tables.movement}}) {
    Result<NumberTable> table = file.ReadTable(wanted.name, wanted.columns);
    if (!table) {
      return table.error();
    }
    *wanted.table = std::move(*table);
    if (wanted.table->rows != tables.gyro.rows) {
      return file.MakeError(ErrorCode::kCorruptData,
                            std::string("dataset ") + wanted.name + " has " +
                                std::to_string(wanted.table->rows) + " rows, /imu_gyr has " +
                                std::to_string(tables.gyro.rows));
    }
  }
  return tables;
}

Eigen::Vector3d Row3(const NumberTable& table, std::size_t row) {
  return {table.at(row, 0), table.at(row, 1), table.at(row, 2)};
}

body::SegmentTruth TruthOf(const Tables& tables, std::size_t row) {
  body::SegmentTruth truth;
  truth.segment = body::Segment::kPelvis;
  const Eigen::Quaterniond q_earth_sensor(tables.truth_q.at(row, 0), tables.truth_q.at(row, 1),
                                          tables.truth_q.at(row, 2), tables.truth_q.at(row, 3));
  const Eigen::Vector3d p_earth_sensor_m = Row3(tables.truth_p, row);
  truth.sensor_valid = q_earth_sensor.coeffs().allFinite() && q_earth_sensor.norm() > 0.5;
  if (truth.sensor_valid) {
    truth.q_earth_sensor = math::Canonical(q_earth_sensor.normalized());
    truth.segment_valid = p_earth_sensor_m.allFinite();
  }
  if (truth.segment_valid) {
    truth.q_earth_segment = truth.q_earth_sensor;
    truth.p_earth_segment_m = p_earth_sensor_m;
  }
  return truth;
}

}  // namespace

bool IsBroad(const Hdf5File& file) { return file.Has("/imu_gyr"); }

Result<Recording> ReadBroad(const Hdf5File& file, const std::string& name,
                            const RecordingOptions& options) {
  const Result<double> rate_hz = file.ReadSamplingRate_hz();
  if (!rate_hz) {
    return rate_hz.error();
  }
  const Result<Tables> tables = ReadTables(file);
  if (!tables) {
    return tables.error();
  }

  Recording recording;
  recording.format = "broad";
  recording.rate_hz = *rate_hz;
  recording.sensors.push_back(
      {.info = MakeReplayInfo(name, name, *rate_hz, options), .segment = body::Segment::kPelvis});
  const SensorUid uid = recording.sensors.front().info.sensor_uid;

  const std::size_t rows = tables->gyro.rows;
  recording.marg.reserve(rows);
  recording.truth.reserve(rows);
  recording.ticks.reserve(rows);
  recording.movement.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const Time at = RowTime(row, *rate_hz);
    sensing::MargSample sample;
    sample.sensor_uid = uid;
    sample.flags = sensing::kTemperatureMissing;
    sample.measured_at = at;
    sample.gyro_rad_s = Row3(tables->gyro, row).cast<float>();
    sample.accel_m_s2 = Row3(tables->accel, row).cast<float>();
    sample.mag_tesla = units::TeslaFromMicrotesla(Row3(tables->mag, row)).cast<float>();
    recording.marg.push_back(sample);

    body::SegmentTruth truth = TruthOf(*tables, row);
    truth.sensor_uid = uid;
    truth.measured_at = at;
    recording.truth.push_back(truth);
    recording.movement.push_back(tables->movement.at(row, 0) != 0.0 ? 1 : 0);
    CloseTick(recording, at);
  }
  return recording;
}

}  // namespace limbcast::gateway
