// What the page about the broad phase leaves to its reader.
#include "broad_phase_methods/sleeping_broad_phase.h"
#include "orchard/runtime/broad_phase.h"

using namespace orchard::runtime;
using namespace orchard::broad_phase_methods;

extern MotionSource source;
extern double t;
extern BroadPhase world;
extern Vec3 origin, direction;
void narrow_phase(const BodyPair& pair);
void wake(BodyIndex body);
