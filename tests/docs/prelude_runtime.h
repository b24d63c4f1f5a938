// What the pages about the run-time leave to their reader.
#include <chrono>
#include <cstdio>
#include <span>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/detector.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/self_collision.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/time_of_impact.h"
#include "orchard/runtime/tree_file.h"

using namespace orchard::runtime;
using namespace std::chrono_literals;

void use(const TreeView& tree);
bool worth_more(double separation_bound), there_is_time();
extern PackedSphereTree tree, tree_a, tree_b;
extern Pose pose, pose_a, pose_b, integrated;
extern NarrowPhase pair;
extern DistanceQuery query;
extern PreparedTree lamp, faucet;
extern std::span<const std::byte> bytes;
extern std::vector<Verdict> verdicts;
extern std::array<double, 3> center, p, q, origin, direction, point;
extern double radius, w, x, y, z;
extern std::array<double, 9> r;
extern std::array<double, 3> t;
extern std::array<float, 9> rotation;
extern std::array<float, 3> translation;
extern float scale;

// Pairs that share a workspace, and batches of them.
extern PackedSphereTree other;
extern Workspace workspace;
extern TreePair both;
extern std::vector<TreePair> many;
extern std::vector<Pose> poses_a, poses_b;
extern std::vector<PreparedTree> parts;
extern std::vector<Pose> rest;
extern Pose before, after, box_pose, hull_pose;
extern double margin, offset;
extern std::array<double, 3> half, normal;
extern std::vector<std::array<double, 3>> corners, translations_a, translations_b;
extern std::vector<std::array<std::uint32_t, 3>> facets;
extern std::vector<std::array<double, 9>> rotations_a, rotations_b;
extern std::vector<Ray> rays;
extern std::vector<std::optional<RayHit>> hits;
extern void* context;
void run(void* context, std::size_t count, Executor::Job job, void* data);
void push(const std::array<double, 3>& place, const std::array<double, 3>& normal, double depth);

// A world.
extern std::size_t count;
extern bool running;
extern double now;
extern std::vector<BodyState> starts;
extern std::vector<Pose> bent;
Vec3 reflected(const Vec3& velocity, const Vec3& normal);
void move(std::vector<BodyState>& states, double time);
void respond(const PairEvent& event);
