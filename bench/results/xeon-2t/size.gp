# Draws size.png: gnuplot size.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set style line 2 linecolor '#D55E00' linewidth 2 pointtype 5 pointsize 1.7
set output 'size.png'.ending
set title 'What a particle-step costs on meshes of growing size'
set key outside top center horizontal
set xlabel 'triangles'
set ylabel 'ns'
set logscale x
set format x '10^{%L}'
set yrange [0:*]
$numbers << EOD
20 38.0615 82.5613
320 45.338 87.3924
5120 42.6822 92.5546
20480 49.7796 101.62
79380 50.6067 106.951
317520 56.8058 123.011
1.3005e+06 62.1573 124.614
4.94018e+06 69.1745 118.059
9.88418e+06 73.1178 110.995
EOD
plot $numbers using 1:2 with linespoints linestyle 1 title 'ricochet: a step of a particle', \
     $numbers using 1:3 with linespoints linestyle 2 title 'bare ray'
set output
