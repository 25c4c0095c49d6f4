# Draws count.png: gnuplot count.gp
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
set output 'count.png'.ending
set title 'Rates with growing numbers of particles'
set key outside top center horizontal
set xlabel 'particles'
set ylabel 'millions a second'
set logscale x
set format x '10^{%L}'
set yrange [0:*]
$numbers << EOD
1000 8.13608 16.0601
10000 9.36877 12.9282
100000 19.9122 12.1622
1e+06 24.8396 11.5471
1e+07 30.5514 12.2185
EOD
plot $numbers using 1:2 with linespoints linestyle 1 title 'ricochet: steps of particles', \
     $numbers using 1:3 with linespoints linestyle 2 title 'bare rays'
set output
