#include "orchard/medial/contacts.h"

namespace orchard {

AxisContacts axis_contacts(const MedialAxis& axis) {
  AxisContacts contacts;
  contacts.sample_places = axis.points;
  contacts.sample_balls.assign(axis.points.size(), kNone);
  for (Index ball = 0; ball < axis.size(); ++ball) {
    for (const Index sample : axis.forming_points[ball]) {
      contacts.balls.push_back(ball);
      contacts.samples.push_back(sample);
      contacts.places.push_back(axis.points[sample]);
      Index& largest = contacts.sample_balls[sample];
      if (largest == kNone || axis.radii[ball] > axis.radii[largest]) largest = ball;
    }
  }
  return contacts;
}

AxisContacts axis_contacts(const Surface& surface, const MedialMesh& mesh) {
  AxisContacts contacts;
  for (Index ball = 0; ball < mesh.size(); ++ball) {
    contacts.balls.push_back(ball);
    contacts.places.push_back(surface.closest(mesh.centers[ball]).position);
  }
  contacts.samples = contacts.sample_balls = contacts.balls;
  contacts.sample_places = contacts.places;
  return contacts;
}

}  // namespace orchard
