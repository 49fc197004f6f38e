#include "common/security/roles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "common/bus/topics.hpp"

namespace limbcast::security {
namespace {

using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAreArray;

template <typename... Ts>
std::vector<std::string> NamesOf(std::tuple<Ts...>* /*list*/) {
  return {std::string(bus::Topic<Ts>::kShortName)...};
}

TEST(RolesTest, EveryTopicOfTheBusCanBeGrantedAndNoOther) {
  EXPECT_THAT(TopicNames(),
              UnorderedElementsAreArray(NamesOf(static_cast<bus::AllTopics*>(nullptr))));
}

TEST(RolesTest, GrantsNameTopicsThatExistOnceAndInOrder) {
  for (const RoleGrant& grant : DefaultRoles()) {
    for (const auto* list : {&grant.publish, &grant.subscribe}) {
      EXPECT_TRUE(std::is_sorted(list->begin(), list->end())) << grant.role;
      EXPECT_EQ(std::adjacent_find(list->begin(), list->end()), list->end()) << grant.role;
      for (const std::string& topic : *list) {
        EXPECT_THAT(TopicNames(), Contains(topic)) << grant.role;
      }
    }
  }
}

TEST(RolesTest, OnlyPostureMakesPeopleAndSpectatorsMakeNothing) {
  for (const RoleGrant& grant : DefaultRoles()) {
    const bool makes_people = grant.role == "posture" || grant.role == "pipeline";
    EXPECT_EQ(std::count(grant.publish.begin(), grant.publish.end(), "skeleton"), makes_people)
        << grant.role;
  }
  EXPECT_THAT(FindRole("spectator")->publish, IsEmpty());
  EXPECT_THAT(FindRole("spectator")->subscribe, Not(Contains("marg")));
}

TEST(RolesTest, EveryTopicHasAWriterAndAReader) {
  for (const std::string& topic : TopicNames()) {
    bool written = false;
    bool heard = false;
    for (const RoleGrant& grant : DefaultRoles()) {
      written |= std::count(grant.publish.begin(), grant.publish.end(), topic) > 0;
      heard |= std::count(grant.subscribe.begin(), grant.subscribe.end(), topic) > 0;
    }
    EXPECT_TRUE(written && heard) << topic;
  }
}

TEST(RolesTest, AnUnknownRoleIsNone) { EXPECT_EQ(FindRole("king"), nullptr); }

}  // namespace
}  // namespace limbcast::security
