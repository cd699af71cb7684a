"""Independent subjects with planted defects: are they found, and does a message name the cause?"""
