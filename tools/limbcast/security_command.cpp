#include "tools/limbcast/security_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>

#include "common/runtime/system_clock.hpp"
#include "common/security/create.hpp"
#include "common/security/credentials.hpp"

namespace limbcast::tool {
namespace {

struct SecurityOptions {
  std::string folder;
  int days = 365;
  int authority_days = 3650;
};

security::CreateOptions MakeOptions(const SecurityOptions& options) {
  const auto for_days = [now = runtime::SystemClock().Now()](int days) {
    // Begins an hour ago: clocks of hosts differ.
    return security::Validity{now - std::chrono::hours(1), now + std::chrono::hours(24) * days};
  };
  security::CreateOptions create;
  create.authority = for_days(options.authority_days);
  create.identities = for_days(options.days);
  return create;
}

void PrintRoles(const std::string& folder) {
  fmt::print("each host needs ca.pem, governance.p7s and the folder of its role:");
  for (const security::RoleGrant& grant : security::DefaultRoles()) {
    fmt::print(" {}", grant.role);
  }
  fmt::print("\nwhoever has {}/private/ca.key can make more: keep it off the hosts\n", folder);
}

int Create(const service::ServiceCommandLine& line, const SecurityOptions& options) {
  const security::CreateOptions create = MakeOptions(options);
  if (const Status created = security::Create(options.folder, create); !created) {
    return line.Fail(created.error());
  }
  fmt::print("{}: credentials until {} UTC\n", options.folder,
             security::IsoText(create.identities.until));
  PrintRoles(options.folder);
  return 0;
}

int Renew(const service::ServiceCommandLine& line, const SecurityOptions& options) {
  const security::CreateOptions create = MakeOptions(options);
  if (const Status renewed = security::Renew(options.folder, create); !renewed) {
    return line.Fail(renewed.error());
  }
  fmt::print("{}: credentials until {} UTC\n", options.folder,
             security::IsoText(create.identities.until));
  return 0;
}

// One line for each role and library that is there; fails when one of them is not in order.
int Check(const service::ServiceCommandLine& line, const SecurityOptions& options) {
  const Time now = runtime::SystemClock().Now();
  std::size_t roles = 0;
  int status = 0;
  for (const security::RoleGrant& grant : security::DefaultRoles()) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(std::filesystem::path(options.folder) / grant.role,
                                       ignored)) {
      continue;  // a host has only what it needs
    }
    ++roles;
    for (const auto library : {security::Library::kCyclone, security::Library::kFast}) {
      const auto files = security::CheckCredentials(options.folder, grant.role, library, now);
      if (!files) {
        status = line.Fail(files.error());
        continue;
      }
      const auto validity = security::ValidityOf(options.folder, grant.role, library);
      fmt::print("{:10} {:8} in order until {} UTC\n", grant.role, security::NameOf(library),
                 validity ? security::IsoText(validity->until) : "?");
    }
  }
  if (roles == 0) {
    return line.Fail({ErrorCode::kNotFound,
                      fmt::format("security: {} has credentials of no role", options.folder)});
  }
  return status;
}

}  // namespace

SubCommand AddSecurityCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<SecurityOptions>();
  CLI::App* app = line.app().add_subcommand(
      "security",
      "Credentials for a network that strangers can neither hear nor disturb (DDS Security).\n"
      "Examples:\n  limbcast security create credentials --days 365\n"
      "  limbcast-fusion --security credentials\n"
      "  limbcast security check credentials\n"
      "  limbcast security renew credentials        the same authority, new identities");
  app->require_subcommand(1);
  const auto with_folder = [&](const char* word, const char* what) {
    CLI::App* sub = app->add_subcommand(word, what);
    sub->add_option("folder", options->folder, "Where they lie")->required()->type_name("DIR");
    return sub;
  };
  const auto with_days = [&](CLI::App* sub) {
    sub->add_option("--days", options->days, "How long identities and permissions are valid")
        ->check(CLI::Range(1, 36500));
    return sub;
  };
  CLI::App* create = with_days(
      with_folder("create", "An authority, and an identity with permissions for each role"));
  create->add_option("--ca-days", options->authority_days, "How long the authority is valid")
      ->check(CLI::Range(1, 36500));
  CLI::App* renew = with_days(with_folder("renew", "New identities by the same authority"));
  with_folder("check", "Whether what is there is in order, and until when");
  return {.app = app, .run = [&line, options, create, renew] {
            return create->parsed()  ? Create(line, *options)
                   : renew->parsed() ? Renew(line, *options)
                                     : Check(line, *options);
          }};
}

}  // namespace limbcast::tool
