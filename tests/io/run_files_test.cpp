#include "ricochet/io/run_folder.h"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

TEST(RunFiles, FrameNamesCarryTheStepWithSixDigitsOrMore) {
    EXPECT_EQ(frame_file_name(0), "particles_000000.vtp");
    EXPECT_EQ(frame_file_name(1234567), "particles_1234567.vtp");
    EXPECT_EQ(step_of_frame_file("particles_000042.vtp"), 42U);
    EXPECT_EQ(step_of_frame_file("particles_1234567.vtp"), 1234567U);
    for (const char* other : {"particles_42.vtp", "particles_.vtp", "particles_00004x.vtp", "particles_000042.vtk",
                              "my_particles_000042.vtp", "particles_0000042.vtp", "particles_-00042.vtp", ""}) {
        EXPECT_FALSE(step_of_frame_file(other)) << other;
    }
}

TEST(RunFiles, ContactFilesAreNamedLikeFramesAndNotTakenForThem) {
    EXPECT_EQ(contact_file_name(42), "contacts_000042.vtp");
    EXPECT_EQ(step_of_contact_file("contacts_1234567.vtp"), 1234567U);
    EXPECT_FALSE(step_of_contact_file("contacts_42.vtp"));
    EXPECT_FALSE(step_of_contact_file(frame_file_name(42)));
    EXPECT_FALSE(step_of_frame_file(contact_file_name(42)));
}

TEST(RunFiles, ColliderNamesHoldPlainCharactersOnly) {
    EXPECT_EQ(collider_file_name(3, "bunny"), "collider_03_bunny.vtp");
    EXPECT_EQ(collider_file_name(0, "../a b"), "collider_00____a_b.vtp");
    EXPECT_EQ(collider_file_name(112, ""), "collider_112.vtp");
    EXPECT_EQ(collider_file_name(0, std::string(500, 'x')).size(), 80U + 16U);
    for (const char* name : {"bunny", "../a b", "", "a_b_c"}) {
        EXPECT_EQ(index_of_collider_file(collider_file_name(7, name)), 7U) << name;
    }
    for (const char* other :
         {"collider_x.vtp", "collider_0.vtp", "collider_00 a.vtp", "collider_00_a.ply", "collider_"}) {
        EXPECT_FALSE(index_of_collider_file(other)) << other;
    }
}

TEST(RunFiles, KnowsItsOwnFilesAndTheirUnfinishedForms) {
    for (const char* own :
         {"run.json", "summary.json", "particles.pvd", "colliders.pvd", "particles_000001.vtp", "collider_00_a.vtp",
          "contacts.pvd", "contacts_000001.vtp", "particles_000001.vtp.123-4.partial",
          "contacts_000001.vtp.123-4.partial", "summary.json.9-0.partial", "compare.json", "report.html", "cost.png",
          "tunnelled.png.7-0.partial"}) {
        EXPECT_TRUE(is_run_file(own)) << own;
    }
    for (const char* other :
         {"notes.txt", "a.partial", "summary.json.partial", "summary.json.x-0.partial", "summary.json~", "contacts.txt",
          "contacts_1.vtp", "my_contacts_000001.vtp", ".ricochet-run", "picture.png", "summary.json.9.partial", ""}) {
        EXPECT_FALSE(is_run_file(other)) << other;
    }
}

}  // namespace
}  // namespace ricochet
