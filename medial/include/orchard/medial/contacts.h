#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/medial_mesh.h"

// Which places of the surface the balls of a medial axis touch, and which ball touches each place.
namespace orchard {

// Contacts of balls with samples of the surface. Balls are numbered as in the medial mesh.
struct AxisContacts {
  // For each contact, its ball (ascending), its sample, and its place on the surface.
  std::vector<Index> balls, samples;
  std::vector<Point> places;
  // For each sample of the surface, its place and the largest ball that touches it there; kNone if there is none.
  std::vector<Point> sample_places;
  std::vector<Index> sample_balls;
};

// Returns the contacts of an axis that was built: samples are its surface points, and contacts the forming points of
// its vertices, which are the first balls of its medial mesh. Linear.
AxisContacts axis_contacts(const MedialAxis& axis);

// Returns those of any other axis: each ball has one contact and one sample, the place of the surface nearest to its
// centre. O(n log n).
AxisContacts axis_contacts(const Surface& surface, const MedialMesh& mesh);

}  // namespace orchard
