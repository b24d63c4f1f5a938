/* Prints each ball of an MJCF file as MuJoCo holds it: x y z r and the name of its body, in the body's frame. */
#include <mujoco/mujoco.h>
#include <stdio.h>

int main(int argc, char** argv) {
  char error[1000] = "";
  if (argc != 2) return 2;
  mjModel* model = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (model == NULL) {
    fprintf(stderr, "%s\n", error);
    return 1;
  }
  for (int g = 0; g < model->ngeom; ++g) {
    const mjtNum* at = model->geom_pos + (size_t)3 * (size_t)g;
    if (model->geom_type[g] != mjGEOM_SPHERE) return 1;
    printf("%.17g,%.17g,%.17g,%.17g,%s\n", at[0], at[1], at[2], model->geom_size[(size_t)3 * (size_t)g],
           mj_id2name(model, mjOBJ_BODY, model->geom_bodyid[g]));
  }
  mj_deleteModel(model);
  return 0;
}
