//! Drive robot arms of Elephant Robotics.
