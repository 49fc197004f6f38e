#include <array>
#include <optional>

#include "common/service/service_command_line.hpp"
#include "tools/limbcast/bench_command.hpp"
#include "tools/limbcast/calibrate_command.hpp"
#include "tools/limbcast/coil_command.hpp"
#include "tools/limbcast/demo_command.hpp"
#include "tools/limbcast/doctor_command.hpp"
#include "tools/limbcast/echo_command.hpp"
#include "tools/limbcast/evaluate_command.hpp"
#include "tools/limbcast/export_command.hpp"
#include "tools/limbcast/run_command.hpp"
#include "tools/limbcast/security_command.hpp"
#include "tools/limbcast/session_command.hpp"
#include "tools/limbcast/smooth_command.hpp"
#include "tools/limbcast/sub_command.hpp"
#include "tools/limbcast/top_command.hpp"

int main(int argc, char** argv) {
  using namespace limbcast;

  service::ServiceCommandLine line("limbcast", "Look at a running pipeline, or run one.",
                                   "  limbcast demo --seconds 20\n"
                                   "  limbcast top --domain 7\n"
                                   "  limbcast echo skeleton --count 1\n");
  line.app().require_subcommand(0, 1);  // none is said below, in our words
  line.app().fallthrough();
  const std::array commands = {
      tool::AddDemoCommand(line),      tool::AddTopCommand(line),
      tool::AddRunCommand(line),       tool::AddEchoCommand(line),
      tool::AddEvaluateCommand(line),  tool::AddSmoothCommand(line),
      tool::AddCalibrateCommand(line), tool::AddCoilCommand(line),
      tool::AddExportCommand(line),    tool::AddBenchCommand(line),
      tool::AddSessionCommand(line),   tool::AddSecurityCommand(line),
      tool::AddDoctorCommand(line),
  };
  if (const std::optional<int> status = line.Parse(argc, argv)) {
    return *status;
  }
  line.StartLog();
  for (const tool::SubCommand& command : commands) {
    if (command.app->parsed()) {
      return command.run();
    }
  }
  return line.Fail({ErrorCode::kInvalidArgument,
                    "a command is missing, e.g. demo or top (see limbcast --help)"});
}
