#include "tools/limbcast/evaluate/published_figures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/expects.hpp"
#include "common/filters/gauss_newton_step.hpp"
#include "common/math/rotation.hpp"
#include "common/units/units.hpp"
#include "tools/limbcast/evaluate/published_experiments.hpp"

namespace limbcast::tool {
namespace {

using Orientations = std::vector<Eigen::Quaterniond>;
using Part = ExperimentPart;
// One figure of one repetition, in degrees.
using Measure = std::function<double(const SimulatedTrial&, const Orientations&)>;

struct Figure {
  std::string what;
  std::string compensated;
  std::string plain;
  Measure measure;
  bool worst = false;
};

struct Experiment {
  std::string name;
  bool is_long = false;
  std::function<ExperimentPlan(const simulation::Random&)> plan;
  std::vector<Figure> figures;
};

template <typename Use>
void ForEachScored(const SimulatedTrial& trial, Part part, Use&& use) {
  for (std::size_t row = 0; row < trial.part.size(); ++row) {
    if (trial.part[row] == part) {
      use(row);
    }
  }
}

double Total_deg(const SimulatedTrial& trial, const Orientations& q, std::size_t row) {
  return units::DegFromRad(math::AngleBetween_rad(q[row], trial.trial.q_reference[row]));
}

Measure Rms(Part part) {
  return [part](const SimulatedTrial& trial, const Orientations& q) {
    ErrorStatistics statistics;
    ForEachScored(trial, part, [&](std::size_t row) {
      statistics.Add(ErrorBetween(q[row], trial.trial.q_reference[row]));
    });
    return statistics.total_rms_deg();
  };
}

Measure Mean(Part part) {
  return [part](const SimulatedTrial& trial, const Orientations& q) {
    double sum = 0.0;
    double count = 0.0;
    ForEachScored(trial, part, [&](std::size_t row) {
      sum += Total_deg(trial, q, row);
      count += 1.0;
    });
    return sum / count;
  };
}

Measure Largest(Part part) {
  return [part](const SimulatedTrial& trial, const Orientations& q) {
    double largest = 0.0;
    ForEachScored(trial, part,
                  [&](std::size_t row) { largest = std::max(largest, Total_deg(trial, q, row)); });
    return largest;
  };
}

// The same of the rotation since the first scored row: a filter that started beside iron cannot
// know where north is, and is asked whether it stays.
Measure RmsSinceFirst(Part part) {
  return [part](const SimulatedTrial& trial, const Orientations& q) {
    ErrorStatistics statistics;
    Eigen::Quaterniond q_truth_estimate = Eigen::Quaterniond::Identity();
    ForEachScored(trial, part, [&](std::size_t row) {
      if (statistics.count() == 0) {
        q_truth_estimate = trial.trial.q_reference[row] * q[row].conjugate();
      }
      statistics.Add(ErrorBetween(q_truth_estimate * q[row], trial.trial.q_reference[row]));
    });
    return statistics.total_rms_deg();
  };
}

double AtOneMinute(const SimulatedTrial& trial, const Orientations& q) {
  return Total_deg(trial, q, std::min<std::size_t>(6000, q.size() - 1));
}

// What a potentiometer in the elbow can tell: the fore arm's angle in the plane in which it moves,
// north and up.
double ElbowAngle_deg(const Eigen::Quaterniond& q_earth_sensor) {
  const Eigen::Vector3d fore_arm_E = q_earth_sensor * Eigen::Vector3d::UnitX();
  return units::DegFromRad(std::atan2(fore_arm_E.z(), fore_arm_E.y()));
}

Measure ElbowRms(Part part) {
  return [part](const SimulatedTrial& trial, const Orientations& q) {
    double sum = 0.0;
    double count = 0.0;
    ForEachScored(trial, part, [&](std::size_t row) {
      const double error_deg =
          ElbowAngle_deg(q[row]) - ElbowAngle_deg(trial.trial.q_reference[row]);
      sum += error_deg * error_deg;
      count += 1.0;
    });
    return std::sqrt(sum / count);
  };
}

void AddStatic(std::vector<Experiment>& all) {
  const auto plan = [](IronArrival arrival) {
    return [arrival](const simulation::Random& random) { return StaticPlan(arrival, random); };
  };
  all.push_back({.name = "static",
                 .is_long = true,
                 .plan = plan(IronArrival::kFromStart),
                 .figures = {{"10 min beside iron: rms of the change", "0.6", "",
                              RmsSinceFirst(Part::kNearIron)}}});
  all.push_back(
      {.name = "static",
       .is_long = true,
       .plan = plan(IronArrival::kAfterStart),
       .figures = {{"10 min, iron brought after the start: rms", "", "", Rms(Part::kNearIron)}}});
}

void AddQuasiStatic(std::vector<Experiment>& all) {
  all.push_back({.name = "quasi-static",
                 .plan = QuasiStaticPlan,
                 .figures = {{"without iron: mean at rest", "1.3", "1.3", Mean(Part::kClean)},
                             {"iron at 5 cm: mean at rest", "1.5", "", Mean(Part::kNearIron)},
                             {"iron at 5 cm: largest", "", "to 40", Largest(Part::kNearIron), true},
                             {"after one minute (gyro alone)", "", "10..25", AtOneMinute}}});
}

void AddElbow(std::vector<Experiment>& all) {
  struct Iron {
    double gap_m;
    const char* name;
    const char* published;
  };
  for (const Iron& iron : {Iron{0.0, "no iron", "1.3"}, Iron{0.10, "iron at 10 cm", "1.3..2.4"},
                           Iron{0.05, "iron at 5 cm", "2.4"}}) {
    for (const double frequency_hz : {0.25, 0.5, 1.0, 2.0}) {
      const Part part = iron.gap_m > 0.0 ? Part::kNearIron : Part::kClean;
      const std::string what =
          std::string(iron.name) + ", " + std::to_string(frequency_hz).substr(0, 4) + " Hz: ";
      all.push_back({.name = "elbow",
                     .plan =
                         [gap_m = iron.gap_m, frequency_hz](const simulation::Random& random) {
                           return ElbowPlan(frequency_hz, gap_m, random);
                         },
                     .figures = {{what + "angle, rms", iron.published, "", ElbowRms(part)},
                                 {what + "whole orientation, rms", "", "", Rms(part)}}});
    }
  }
}

void AddChapterThree(std::vector<Experiment>& all) {
  all.push_back({.name = "arm",
                 .plan = [](const simulation::Random& random) { return ArmPlan(false, random); },
                 .figures = {{"no metal: rms", "2.6", "", Rms(Part::kClean)}}});
  all.push_back({.name = "arm",
                 .plan = [](const simulation::Random& random) { return ArmPlan(true, random); },
                 .figures = {{"near metal: rms", "3.6", "13.1", Rms(Part::kNearIron)}}});
  all.push_back({.name = "assembly",
                 .plan = AssemblyPlan,
                 .figures = {{"on a metal case: rms", "3.6", "19.8", Rms(Part::kNearIron)}}});
}

std::vector<Experiment> AllExperiments() {
  std::vector<Experiment> all;
  AddStatic(all);
  AddQuasiStatic(all);
  AddElbow(all);
  AddChapterThree(all);
  return all;
}

Orientations IntegrateGyro(const OrientationTrial& trial) {
  Orientations q = {trial.q_reference.front()};
  for (std::size_t row = 1; row < trial.samples.size(); ++row) {
    const double dt_s =
        ToSeconds(trial.samples[row].measured_at - trial.samples[row - 1].measured_at);
    q.push_back((q.back() * math::ExpSO3(dt_s * trial.samples[row].gyro_rad_s.cast<double>()))
                    .normalized());
  }
  return q;
}

Orientations Run(const FigureFilter& filter, const OrientationTrial& trial) {
  if (filter.name.empty()) {
    return IntegrateGyro(trial);
  }
  auto made = filters::MakeFilter(filter.name, filter.settings);
  Expects(made.ok(), "a filter that FindFigureFilter found");
  return EvaluateTrial(trial, **made).q_earth_sensor;
}

Spread SpreadOf(const std::vector<double>& values_deg) {
  Spread spread;
  const auto n = static_cast<double>(values_deg.size());
  for (const double value : values_deg) {
    spread.mean_deg += value / n;
    spread.max_deg = std::max(spread.max_deg, value);
  }
  for (const double value : values_deg) {
    spread.std_deg += (value - spread.mean_deg) * (value - spread.mean_deg) / n;
  }
  spread.std_deg = std::sqrt(spread.std_deg);
  return spread;
}

// All repetitions of one experiment with every filter.
std::vector<PublishedRow> RunExperiment(const Experiment& experiment,
                                        const PublishedOptions& options, int repetitions,
                                        const std::function<void()>& before_each) {
  std::vector<std::map<std::string, std::vector<double>>> values(experiment.figures.size());
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    before_each();
    const std::string stream = experiment.figures.front().what + std::to_string(repetition);
    const SimulatedTrial trial =
        Simulate(experiment.name, experiment.plan(simulation::Random(options.seed, stream)),
                 simulation::Random(options.seed, "sensor of " + stream));
    for (const FigureFilter& filter : options.filters) {
      const Orientations q = Run(filter, trial.trial);
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i][filter.label].push_back(experiment.figures[i].measure(trial, q));
      }
    }
  }
  std::vector<PublishedRow> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Figure& figure = experiment.figures[i];
    PublishedRow row{experiment.name, figure.what,  figure.compensated,
                     figure.plain,    figure.worst, {}};
    for (const auto& [label, values_deg] : values[i]) {
      row.simulated[label] = SpreadOf(values_deg);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Result<FigureFilter> FindFigureFilter(const std::string& label) {
  if (label == "gyro") {
    return FigureFilter{label, "", {}};
  }
  if (label == "ckf-thesis") {
    return FigureFilter{label, "ckf", {{"structure", "thesis"}, {"disturbance_measure", "change"}}};
  }
  if (label == "ckf-iron") {
    return FigureFilter{label,
                        "ckf",
                        {{"pole_disturbance", "0.999"},
                         {"drive_norm", "0.3"},
                         {"drive_dip_per_rad", "0.3"},
                         {"walk_gyro_bias_rad_s", "1.75e-5"}}};
  }
  if (auto made = filters::MakeFilter(label); !made) {
    return Error{made.error().code,
                 made.error().message + "; here also ckf-thesis, ckf-iron, gyro"};
  }
  return FigureFilter{label, label, {}};
}

std::vector<PublishedRow> ComputePublishedRows(
    const PublishedOptions& options,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& progress) {
  constexpr int kLongShare = 3;
  std::vector<Experiment> experiments = AllExperiments();
  std::erase_if(experiments, [&](const Experiment& e) {
    return !options.only.empty() && e.name != options.only;
  });
  const auto repetitions = [&](const Experiment& e) {
    return e.is_long ? (options.trials + kLongShare - 1) / kLongShare : options.trials;
  };
  std::size_t all = 0;
  for (const Experiment& experiment : experiments) {
    all += static_cast<std::size_t>(repetitions(experiment));
  }
  std::size_t done = 0;
  std::vector<PublishedRow> rows;
  for (const Experiment& experiment : experiments) {
    const auto more = RunExperiment(experiment, options, repetitions(experiment), [&] {
      if (progress) {
        progress(done, all, experiment.name + " " + experiment.figures.front().what);
      }
      ++done;
    });
    rows.insert(rows.end(), more.begin(), more.end());
  }
  if (progress) {
    progress(all, all, "");
  }
  return rows;
}

std::vector<TableOneRow> ComputeTableOne(std::uint64_t seed, int trials) {
  std::vector<TableOneRow> rows = {{0.0, {6.68e-3, 3.17e-5, 9.3e-8}, {}},
                                   {0.001, {6.65e-3, 8.30e-4, 8.12e-4}, {}},
                                   {0.01, {1.11e-2, 8.13e-3, 7.87e-3}, {}},
                                   {0.1, {7.97e-2, 8.63e-2, 8.30e-2}, {}}};
  const double dip_rad = units::RadFromDeg(60.0);
  const Eigen::Vector3d m = Eigen::Vector3d::UnitZ();  // NED
  const Eigen::Vector3d n(std::cos(dip_rad), 0.0, std::sin(dip_rad));
  const auto components = [](const Eigen::Quaterniond& q) {
    return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  };
  const auto quaternion = [](const Eigen::Vector4d& c) {
    return Eigen::Quaterniond(c[0], c[1], c[2], c[3]);
  };
  for (TableOneRow& row : rows) {
    simulation::Random random(seed, "table 1 " + std::to_string(row.max_noise));
    for (int trial = 0; trial < trials; ++trial) {
      const Eigen::Quaterniond q_true = random.Rotation();
      filters::Vector6 y0 = filters::ComputedMeasurement(q_true, m, n);
      y0.head<3>() += random.Uniform3(row.max_noise);
      y0.tail<3>() += random.Uniform3(row.max_noise);
      const Eigen::Vector3d m0 = y0.head<3>().normalized();
      const Eigen::Vector3d n0 = y0.tail<3>().normalized();
      Eigen::Vector4d start = components(q_true);
      for (double& component : start) {
        component += random.Uniform(-0.1, 0.1);
      }
      Eigen::Quaterniond q = quaternion(start).normalized();
      for (double& cell : row.simulated) {
        // Taken before the normalisation, as the published first cell shows (orientation.md 8).
        const Eigen::Vector4d stepped = components(q) + filters::FullStep(q, m, n, m0, n0, 1.0);
        const double error = std::min((stepped - components(q_true)).squaredNorm(),
                                      (stepped + components(q_true)).squaredNorm());
        cell += error / trials;
        q = quaternion(stepped).normalized();
      }
    }
    for (double& cell : row.simulated) {
      cell = std::sqrt(cell);
    }
  }
  return rows;
}

}  // namespace limbcast::tool
