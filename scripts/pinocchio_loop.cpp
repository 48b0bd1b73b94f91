// Pinocchio's own loop in C++, for bench_batch.py: poses and body Jacobians of some frames at many configurations.

#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/model.hpp>
#include <pinocchio/serialization.hpp>
#include <string>
#include <thread>
#include <vector>

using namespace pinocchio;

struct Robot {
  Model model;
  std::vector<FrameIndex> frames;
};

extern "C" {

// A model from the file that Model.saveToText wrote.
void* open_robot(const char* file, const long* frames, long count) {
  Robot* robot = new Robot;
  serialization::loadFromText(robot->model, std::string(file));
  robot->frames.assign(frames, frames + count);
  return robot;
}

// q (n, nq) to T (n, F, 4, 4) and, unless it is null, J (n, F, 6, nv), all row by row.
void run(void* handle, const double* q, long n, double* T, double* J, long threads) {
  const Robot& robot = *static_cast<Robot*>(handle);
  const Model& model = robot.model;
  const long nq = model.nq, nv = model.nv, frames = robot.frames.size();
  auto work = [&](long from, long to) {
    Data data(model);
    Eigen::Matrix<double, 6, Eigen::Dynamic> columns(6, nv);
    for (long i = from; i < to; ++i) {
      Eigen::Map<const Eigen::VectorXd> x(q + i * nq, nq);
      if (J)
        computeJointJacobians(model, data, x);
      else
        forwardKinematics(model, data, x);
      for (long f = 0; f < frames; ++f) {
        const long at = i * frames + f;
        const SE3& pose = updateFramePlacement(model, data, robot.frames[f]);
        Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(T + 16 * at) = pose.toHomogeneousMatrix();
        if (!J) continue;
        columns.setZero();
        getFrameJacobian(model, data, robot.frames[f], LOCAL, columns);
        Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>(J + 6 * nv * at, 6, nv) = columns;
      }
    }
  };
  std::vector<std::thread> others;
  for (long t = 1; t < threads; ++t) others.emplace_back(work, n * t / threads, n * (t + 1) / threads);
  work(0, n / threads);
  for (std::thread& other : others) other.join();
}
}
