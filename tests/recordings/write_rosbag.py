#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a CARMEN log as a ROS 1 bag with ROS's own library: write_rosbag.py LOG BAG none|bz2|lz4.

Needs Debian's python3-rosbag, python3-nav-msgs, python3-sensor-msgs and python3-tf2-msgs; ends with
exit code 77 where they are absent.
"""
import math
import sys

try:
    import rosbag
    import rospy
    from geometry_msgs.msg import TransformStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan
    from tf2_msgs.msg import TFMessage
except ImportError as error:
    print(error)
    sys.exit(77)


def odometry(stamp, x, y, yaw):
    message = Odometry()
    message.header.stamp = stamp
    message.header.frame_id = 'odom'
    message.child_frame_id = 'base_link'
    message.pose.pose.position.x = x
    message.pose.pose.position.y = y
    message.pose.pose.orientation.z = math.sin(yaw / 2)
    message.pose.pose.orientation.w = math.cos(yaw / 2)
    return message


def scan(stamp, ranges):
    message = LaserScan()
    message.header.stamp = stamp
    message.header.frame_id = 'laser'
    message.angle_min = -math.pi / 2
    message.angle_max = math.pi / 2
    message.angle_increment = math.pi / (len(ranges) - 1)
    message.range_max = 80
    message.ranges = ranges
    return message


def mount(stamp, x, yaw):
    transform = TransformStamped()
    transform.header.stamp = stamp
    transform.header.frame_id = 'base_link'
    transform.child_frame_id = 'laser'
    transform.transform.translation.x = x
    transform.transform.rotation.z = math.sin(yaw / 2)
    transform.transform.rotation.w = math.cos(yaw / 2)
    return TFMessage([transform])


def main(log, bag, compression):
    with rosbag.Bag(bag, 'w', compression=compression, chunk_threshold=50000) as out:
        first = True
        for line in open(log):
            fields = line.split()
            if not fields or fields[0] != 'FLASER':
                continue
            count = int(fields[1])
            ranges = [float(f) for f in fields[2:2 + count]]
            laser_x, laser_y, _, x, y, yaw, stamp = [float(f) for f in fields[2 + count:9 + count]]
            time = rospy.Time.from_sec(stamp)
            if first:
                forward = math.hypot(laser_x - x, laser_y - y)
                out.write('/tf_static', mount(time, forward, 0), time)
                first = False
            out.write('/odom', odometry(time, x, y, yaw), time)
            out.write('/scan', scan(time, ranges), time)


main(*sys.argv[1:])
