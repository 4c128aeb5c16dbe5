// Bullet's btSoftBody behind three functions.
//
// Links as taut has springs: structural, diagonal, and two particles on. In random order, as Bullet's own helpers do it: in
// the order of the grid its Gauss-Seidel sweeps pull the sheet to one side.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <vector>

namespace {

struct Scene {
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher;
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btSoftRigidDynamicsWorld world;
    btSoftBody *body = nullptr;
    btScalar dt;
    int substeps;

    Scene(int side, int substeps_, int iterations, double side_m, double mass_kg, double damping_per_s, double rate_hz)
        : dispatcher(&configuration), world(&dispatcher, &broadphase, &solver, &configuration),
          dt(btScalar(1.0 / (rate_hz * substeps_))), substeps(substeps_)
    {
        const btVector3 gravity(0, btScalar(-9.81), 0);
        world.setGravity(gravity);
        world.getWorldInfo().m_gravity = gravity;
        world.getWorldInfo().m_dispatcher = &dispatcher;
        world.getWorldInfo().m_broadphase = &broadphase;
        world.getWorldInfo().air_density = 0;
        world.getWorldInfo().m_sparsesdf.Initialize();

        const btScalar spacing = btScalar(side_m / (side - 1));
        std::vector<btVector3> x;
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                x.emplace_back(spacing * btScalar(column), btScalar(0), spacing * btScalar(row));
            }
        }
        body = new btSoftBody(&world.getWorldInfo(), side * side, x.data(), nullptr);
        const auto link = [&](int row, int column, int down, int right) {
            if (row + down < side && column + right >= 0 && column + right < side) {
                body->appendLink(row * side + column, (row + down) * side + column + right);
            }
        };
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                link(row, column, 0, 1);
                link(row, column, 1, 0);
                link(row, column, 1, 1);
                link(row, column, 1, -1);
                link(row, column, 0, 2);
                link(row, column, 2, 0);
            }
        }
        body->m_materials[0]->m_kLST = 1;
        body->m_cfg.piterations = iterations;
        body->m_cfg.kDP = btScalar(damping_per_s) * dt;
        body->m_cfg.collisions = 0;
        body->setTotalMass(btScalar(mass_kg));
        body->setMass(0, 0);
        body->setMass(side - 1, 0);
        body->randomizeConstraints();
        body->setActivationState(DISABLE_DEACTIVATION);
        world.addSoftBody(body);
    }

    ~Scene()
    {
        world.removeSoftBody(body);
        delete body;
    }
};

} // namespace

extern "C" {

void *bullet_new(int side, int substeps, int iterations, double side_m, double mass_kg, double damping_per_s, double rate_hz)
{
    return new Scene(side, substeps, iterations, side_m, mass_kg, damping_per_s, rate_hz);
}

// One frame.
void bullet_step(void *scene)
{
    Scene &s = *static_cast<Scene *>(scene);
    for (int i = 0; i < s.substeps; ++i) {
        s.world.stepSimulation(s.dt, 0);
    }
}

void bullet_positions(const void *scene, float *xyz)
{
    const Scene &s = *static_cast<const Scene *>(scene);
    for (int i = 0; i < s.body->m_nodes.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            xyz[3 * i + axis] = float(s.body->m_nodes[i].m_x[axis]);
        }
    }
}

void bullet_delete(void *scene)
{
    delete static_cast<Scene *>(scene);
}
}
